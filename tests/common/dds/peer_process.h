// SPDX-License-Identifier: Apache-2.0
// A dds_peer in a separate process, controlled over pipes.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <csignal>
#include <string>
#include <vector>

#include "common/config/run_files.h"

namespace shoal::dds {

class PeerProcess {
 public:
  // Starts the process and waits until it has joined the domain. If it does not join, fails the
  // test (the reason is on stderr).
  PeerProcess(const std::string& role, const ClusterAddress& address);
  // A coordinator that claims a domain (see address()).
  PeerProcess() : PeerProcess(std::string()) {}
  // A coordinator with a folder of credentials.
  explicit PeerProcess(const std::string& secure);
  // Kills the process if it has not ended.
  ~PeerProcess();
  PeerProcess(const PeerProcess&) = delete;
  PeerProcess& operator=(const PeerProcess&) = delete;

  // Address of the claimed domain.
  const ClusterAddress& address() const { return address_; }

  // Sends a command and returns the answer line, or "" at the deadline or if the process has ended.
  // "got" lines that precede the answer are kept for NextGot.
  std::string Ask(const std::string& command,
                  std::chrono::milliseconds deadline = std::chrono::seconds(40));
  // Send and Answer: the two steps of Ask.
  void Send(const std::string& command);
  std::string Answer(std::chrono::milliseconds deadline = std::chrono::seconds(40));
  // The next "got" line; empty at the deadline.
  std::string NextGot(std::chrono::milliseconds deadline = std::chrono::seconds(10));

  void Signal(int signal) const { kill(pid_, signal); }
  // Sends SIGKILL and waits for the process's end.
  void Kill();
  // Asks the process to end, and waits for its end.
  void Quit();

 private:
  void Spawn(std::vector<std::string> arguments);
  // The next line, an answer or a "got" line.
  std::string ReadLine(std::chrono::steady_clock::time_point end);
  std::string NextLine(bool want_got, std::chrono::milliseconds deadline);

  ClusterAddress address_;
  pid_t pid_ = -1;
  int to_child_ = -1, from_child_ = -1;
  std::string buffer_;           // text that was read and is not yet a whole line
  std::string pending_got_;      // lines seen while waiting for an answer
  std::string pending_answers_;  // lines seen while waiting for a "got"
};

}  // namespace shoal::dds
