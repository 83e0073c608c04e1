// SPDX-License-Identifier: Apache-2.0
// The processes of a simulated run: coordinators and their children, subject to the run's faults.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/link/local_network.h"
#include "launch/processes/running_process.h"
#include "tests/simulation/fiber_scheduler.h"

namespace shoal::simulation {

// One process, its threads and its place on the link. The object outlives the process, because
// fibers may still refer to it.
class SimulatedProcess {
 public:
  // Borrows scheduler and network. The log is written to `log_file`. `outlives_parent`: the process
  // gets no signal when the coordinator dies.
  SimulatedProcess(FiberScheduler& scheduler, link::LocalNetwork& network, link::Role role,
                   const std::string& name, const std::string& log_file, bool outlives_parent);

  // Runs `body`, whose result is the exit code, in the first thread of `self`. After an Error, the
  // process ends with the exit code of this error and logs the error line, like Shoal's programs.
  static void Start(const std::shared_ptr<SimulatedProcess>& self, const std::string& program,
                    std::function<int(link::Hub&)> body);

  // These functions return false if the process has ended.
  bool Kill();
  bool Pause(std::chrono::milliseconds span);
  bool Stall(uint64_t which_thread, std::chrono::milliseconds span);
  bool SlowDown(std::chrono::milliseconds span);
  bool Disconnect();
  bool Reconnect();
  bool RequestStop();

  const std::string& name() const { return name_; }
  bool outlives_parent() const { return outlives_parent_; }
  ThreadGroup& group() { return group_; }
  const std::optional<launch::ExitStatus>& ended() const { return ended_; }
  // Time of the process's end; undefined before the end.
  SteadyTime ended_at() const { return ended_at_; }
  // The error line; empty if there was no Error.
  const std::string& last_words() const { return last_words_; }

 private:
  void End(launch::ExitStatus status);

  FiberScheduler& scheduler_;
  link::LocalNetwork& network_;
  const std::string name_;
  const bool outlives_parent_;
  ThreadGroup group_;
  std::unique_ptr<link::Hub> hub_;
  std::optional<launch::ExitStatus> ended_;
  SteadyTime ended_at_{};
  std::string last_words_;
};

// The main function of a child. Gets the child's hub; returns the exit code.
using ProcessBody = std::function<int(const launch::ProcessSpec&, link::Hub&)>;

class SimulatedProcesses {
 public:
  // Borrows scheduler and network.
  SimulatedProcesses(FiberScheduler& scheduler, link::LocalNetwork& network, ProcessBody body)
      : scheduler_(scheduler), network_(network), body_(std::move(body)) {}

  // Starts a child of the coordinator. Destruction of the result kills the child.
  std::unique_ptr<launch::RunningProcess> StartChild(const launch::ProcessSpec& spec);
  // Starts a process that is not a child of the coordinator. Find also finds this process by name.
  std::shared_ptr<SimulatedProcess> StartOther(const std::string& name, link::Role role,
                                               const std::string& log_file,
                                               std::function<int(link::Hub&)> body);

  // The newest living process of this name; null if there is none.
  std::shared_ptr<SimulatedProcess> Find(const std::string& name) const;
  // Sends a stop signal to the children that do not outlive the coordinator.
  void OnCoordinatorDeath();

 private:
  class Handle;

  FiberScheduler& scheduler_;
  link::LocalNetwork& network_;
  const ProcessBody body_;
  std::vector<std::shared_ptr<SimulatedProcess>> children_;  // oldest first
  std::map<std::string, std::shared_ptr<SimulatedProcess>> newest_;
};

}  // namespace shoal::simulation
