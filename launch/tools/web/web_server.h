// SPDX-License-Identifier: Apache-2.0
// `shoal web`: serves the page.
#pragma once

#include <memory>
#include <string>

#include "launch/watch/listen_address.h"
#include "launch/watch/run_target.h"

namespace shoal::launch {

struct WebOptions {
  std::string run{};  // the only run shown: name in run_dir, or folder; empty = all runs
  std::string run_dir = "runs";
  std::string secure{};    // folder of credentials; empty = as each run's cluster.json says
  ListenAddress listen{};  // port 0: the system chooses a port
};

class WebServer {
 public:
  // Listens, and answers on its own threads until destruction. The destructor waits only briefly
  // for each thread. Throws Error if the run does not exist, if the address or port cannot be used,
  // or if a part of the page is not installed.
  explicit WebServer(const WebOptions& options);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  uint16_t port() const;
  const std::string& token() const;  // gives access to the page (access.h)
  // "http://127.0.0.1:8470/?token=..."
  std::string Url() const;
  // Leaves runs that no page shows any more. Call every few seconds.
  void Tend();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shoal::launch
