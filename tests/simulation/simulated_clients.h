// SPDX-License-Identifier: Apache-2.0
// Simulates users in other terminals: `shoal stop`, `set`, `scale` and `attach` with the product's
// client, over the simulated link. Each command must end in time with a documented answer.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tests/simulation/train_session.h"

namespace shoal::simulation {

// One command of a user.
struct ClientCall {
  std::string verb;
  std::vector<std::string> arguments{};
  SteadyTime begun{};
  SteadyTime heard{};  // arrival of the newest view
  // The coordinator that accepted the order; null before the acceptance.
  std::shared_ptr<SimulatedProcess> answerer{};
  std::string last{};   // last line of the command, or message of its Error
  bool failed = false;  // the command ended with an Error
  int code = 0;         // exit code; valid if `ended`
  bool ended = false;
};

// The present deadline of the call; it may change while the call is running.
SteadyTime DeadlineOf(const ClientCall& call);
// Whether the call ended in a documented way.
bool IsDocumented(const ClientCall& call);

class SimulatedClients {
 public:
  // Borrows the world.
  explicit SimulatedClients(const World& world) : world_(world) {}

  // Begins a command: "scale 3".
  void Begin(const std::string& words);
  // Begins `shoal attach`; Ctrl-C ends it after `span`.
  void Attach(std::chrono::milliseconds span);
  // Waits for all commands. A command that does not end in time breaks a promise.
  void WaitForAll();

 private:
  std::shared_ptr<SimulatedProcess> Start(const std::string& words);
  // The body of a client's process; returns the exit code.
  int Run(const std::string& name, ClientCall* call, uint64_t id, link::Hub& hub);
  int Carry(const std::string& name, ClientCall* call, uint64_t id, link::Hub& hub);
  void Judge(const std::string& name, const ClientCall& call);

  const World& world_;
  std::vector<std::unique_ptr<ClientCall>> calls_;
};

}  // namespace shoal::simulation
