// SPDX-License-Identifier: Apache-2.0
// The part of an implementation of the link that the contract suite needs: members of a run, each
// with a hub of its own, driven by the commands of peer_commands.h.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "common/link/role.h"

namespace shoal::link {

// One member of the run. Destroying it ends it, in order or not.
class ContractPeer {
 public:
  using milliseconds = std::chrono::milliseconds;

  virtual ~ContractPeer() = default;
  virtual void Send(const std::string& command) = 0;
  // The next answer line; empty when none comes within the deadline.
  virtual std::string Answer(milliseconds deadline = std::chrono::seconds(40)) = 0;
  // The next "got" line; empty when none comes within the deadline.
  virtual std::string NextGot(milliseconds deadline = std::chrono::seconds(20)) = 0;
  // Destroys writers, readers and hub, and returns after that.
  virtual void Quit() = 0;
  // Dies without a word. Only its destruction may follow.
  virtual void Kill() = 0;

  std::string Ask(const std::string& command) {
    Send(command);
    return Answer();
  }
};

class ContractNetwork {
 public:
  virtual ~ContractNetwork() = default;
  // At most one coordinator, learner and replay at a time.
  virtual std::unique_ptr<ContractPeer> Join(Role role) = 0;
};

// Each member is a thread of this process.
std::unique_ptr<ContractNetwork> MakeLocalContractNetwork();
// Each member is a process.
std::unique_ptr<ContractNetwork> MakeDdsContractNetwork();

}  // namespace shoal::link
