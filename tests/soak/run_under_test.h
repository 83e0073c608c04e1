// SPDX-License-Identifier: Apache-2.0
// A cheap training run of the real programs. The test observes the run's processes, their reports,
// and the run's end from outside.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "launch/processes/child_process.h"
#include "tests/support/report_reader.h"

namespace shoal::soak {

// Thrown if a rule was broken; the message describes the rule and the fault.
struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct RunOptions {
  std::filesystem::path folder;  // empty; receives the run, its output and its temporary files
  std::filesystem::path programs;
  int actors = 2;
  int64_t seed = 1;
  std::string preset = "fetch-reach-state";
  std::string environment{};      // value for `shoal train --env`; empty = the preset's task
  std::vector<std::string> keys;  // further KEY=VALUE
};

class RunUnderTest {
 public:
  // Starts the run. Returns when replay and learner make progress. Throws Broken.
  explicit RunUnderTest(const RunOptions& options);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path temporary_files() const { return options_.folder / "tmp"; }
  // "replay-0", "learner-0", "actor-0", ..., "eval-0".
  std::vector<std::string> ProcessNames() const;
  // Pid of the living process of this name (also "coordinator"); 0 during a restart of the process.
  pid_t Pid(const std::string& name) const;

  struct Progress {
    double stored_steps = 0, updates = 0;
  };
  // Progress from the newest reports. Throws Broken if stored records have decreased, or if batches
  // are no longer passed in shared memory.
  Progress TakeProgress();
  // Waits until a new process of this name (not `former`) has reported, and steps and updates have
  // increased since `before`. Throws Broken at `deadline`.
  void AwaitRecovery(const std::string& process, pid_t former, const Progress& before,
                     std::chrono::seconds deadline);

  // Kills the coordinator and waits until the other processes have ended by themselves. Throws
  // Broken if a process has not ended at `deadline`, or ended in another way.
  void KillCoordinator(std::chrono::seconds deadline);
  // Restarts the run with --resume. The run must have ended.
  void Resume();

  // Depths of queues from the newest reports: metric -> depth.
  std::map<std::string, double> QueueDepths();

  // Stops the run with SIGINT and waits for its end. Throws Broken unless the exit code is 0 and
  // the account of records balances.
  nlohmann::json End(std::chrono::seconds deadline);
  // Throws Broken if the coordinator has ended. Throws Error after a stop signal.
  void CheckAlive();
  // Last lines of the coordinator's output, for messages.
  std::string Output() const;

 private:
  launch::ProcessSpec Spec(const std::vector<std::string>& arguments) const;
  std::vector<std::string> FirstArguments() const;
  void CheckAcknowledged(const nlohmann::json& accounting);
  const nlohmann::json& Report(const std::string& process);

  const RunOptions options_;
  const std::filesystem::path path_;
  launch::ChildProcess coordinator_;
  ReportReader reports_;
  double most_stored_ = 0;
  // Number of records acknowledged to each actor process, from the process's last report.
  std::map<std::pair<std::string, pid_t>, double> acknowledged_;
};

}  // namespace shoal::soak
