// SPDX-License-Identifier: Apache-2.0
// The processes of a simulated run, started by its coordinator and harmed by its faults.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "common/link/local_network.h"
#include "launch/processes/running_process.h"
#include "tests/simulation/fiber_scheduler.h"

namespace shoal::simulation {

// The body of a process, with its hub; returns the exit code.
using ProcessBody = std::function<int(const launch::ProcessSpec&, link::Hub&)>;

class SimulatedProcesses {
 public:
  // Borrows scheduler and network.
  SimulatedProcesses(FiberScheduler& scheduler, link::LocalNetwork& network, ProcessBody body)
      : scheduler_(scheduler), network_(network), body_(std::move(body)) {}

  std::unique_ptr<launch::RunningProcess> Start(const launch::ProcessSpec& spec);

  // Does what SIGKILL does. False: no process of that name runs.
  bool Kill(const std::string& name);
  // Does what SIGSTOP and, after `span`, SIGCONT do.
  bool Pause(const std::string& name, std::chrono::milliseconds span);

 private:
  class Process;
  class Handle;

  FiberScheduler& scheduler_;
  link::LocalNetwork& network_;
  const ProcessBody body_;
  std::map<std::string, std::shared_ptr<Process>> running_;  // the newest of each name
};

}  // namespace shoal::simulation
