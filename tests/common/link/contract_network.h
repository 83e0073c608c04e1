// SPDX-License-Identifier: Apache-2.0
// Members of a run, which each implementation of the link provides for the contract suite. Every
// member has its own hub and executes the commands of peer_commands.h.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "common/link/role.h"

namespace shoal::link {

// One member of the run. The destructor ends the member, cleanly or not.
class ContractPeer {
 public:
  using milliseconds = std::chrono::milliseconds;

  virtual ~ContractPeer() = default;
  virtual void Send(const std::string& command) = 0;
  // The next answer line; empty at the deadline.
  virtual std::string Answer(milliseconds deadline = std::chrono::seconds(40)) = 0;
  // The next "got" line; empty at the deadline.
  virtual std::string NextGot(milliseconds deadline = std::chrono::seconds(20)) = 0;
  // Destroys writers, readers and hub before it returns.
  virtual void Quit() = 0;
  // Ends the member without notice to the other members. Only the destructor may be called
  // afterwards.
  virtual void Kill() = 0;

  std::string Ask(const std::string& command) {
    Send(command);
    return Answer();
  }
};

class ContractNetwork {
 public:
  virtual ~ContractNetwork() = default;
  // Adds a member. At most one coordinator, one learner and one replay may exist at a time.
  virtual std::unique_ptr<ContractPeer> Join(Role role) = 0;
};

// Each member is a thread of this process.
std::unique_ptr<ContractNetwork> MakeLocalContractNetwork();
// Each member is a process.
std::unique_ptr<ContractNetwork> MakeDdsContractNetwork();

}  // namespace shoal::link
