// SPDX-License-Identifier: Apache-2.0
// A cheap training run of the real programs, observed from outside: its processes, their reports,
// its end.
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

// A rule was broken; the message describes the rule and the fault.
struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct RunOptions {
  std::filesystem::path folder;  // empty; receives the run, its output and its temporary files
  std::filesystem::path programs;
  int actors = 2;
  int64_t seed = 1;
  std::string preset = "fetch-reach-state";
  std::string environment{};      // as `shoal train --env` takes it; empty = the preset's task
  std::vector<std::string> keys;  // further KEY=VALUE
};

class RunUnderTest {
 public:
  // Starts the run. Returns once replay and learner make progress. Throws Broken.
  explicit RunUnderTest(const RunOptions& options);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path temporary_files() const { return options_.folder / "tmp"; }
  // "replay-0", "learner-0", "actor-0", ..., "eval-0".
  std::vector<std::string> ProcessNames() const;
  // The living process of that name ("coordinator" too); 0 while it is being restarted.
  pid_t Pid(const std::string& name) const;

  struct Progress {
    double stored_steps = 0, updates = 0;
  };
  // Progress from the newest reports. Throws Broken if stored records have decreased, or if batches
  // are no longer passed in shared memory.
  Progress TakeProgress();
  // Waits until a new process of this name (not `former`) has reported after `since`, and steps and
  // updates have increased since `before`. Throws Broken at `deadline`.
  void AwaitRecovery(const std::string& process, pid_t former, const Progress& before,
                     std::chrono::seconds deadline);

  // Kills the coordinator and waits until the other processes have ended by themselves. Throws
  // Broken if one has not ended at `deadline`, or ended in another way.
  void KillCoordinator(std::chrono::seconds deadline);
  // Restarts the run with --resume. The run must have ended.
  void Resume();

  // Depths of queues from the newest reports: figure -> depth.
  std::map<std::string, double> QueueDepths();

  // Stops the run with SIGINT and waits. Throws Broken unless the exit code is 0 and the account
  // balances.
  nlohmann::json End(std::chrono::seconds deadline);
  // Throws Broken if the coordinator has ended, Error after a stop signal.
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
  // Records acknowledged to each actor process, by its last report.
  std::map<std::pair<std::string, pid_t>, double> acknowledged_;
};

}  // namespace shoal::soak
