// SPDX-License-Identifier: Apache-2.0
// A training run of the real programs, which a test disturbs while the run is running.
#pragma once

#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "common/base/clock.h"
#include "common/base/stop.h"
#include "launch/processes/child_process.h"
#include "tests/support/paths.h"
#include "tests/support/report_reader.h"
#include "tests/support/training_run.h"

namespace shoal {

class RunningTraining {
 public:
  using Environment = std::vector<std::pair<std::string, std::string>>;

  // Starts `shoal train`. `command`: words from TrainingRun::Command, or the words of a resume.
  RunningTraining(const TrainingRun& run, std::vector<std::string> command,
                  const Environment& environment = {})
      : run_(run),
        reports_(ReportsFromNowOn(run)),
        child_(Spec(run, std::move(command), environment)) {}

  pid_t pid() const { return child_.pid(); }
  ReportReader& reports() { return reports_; }

  // Waits until the replay has stored `steps` more steps. Returns false at the deadline.
  bool WaitForMoreSteps(int64_t steps) {
    const nlohmann::json newest = reports_.Await("replay");
    return !newest.is_null() && WaitForSteps(Stored(newest) + steps);
  }
  bool WaitForSteps(int64_t steps, std::chrono::seconds deadline = std::chrono::seconds(60)) {
    return !reports_
                .WaitFor(
                    "replay", [&](const auto& r) { return Stored(r) >= steps; }, deadline)
                .is_null();
  }

  // Sends Ctrl-C.
  void Interrupt() { child_.Signal(SIGINT); }
  // Waits for the run's end. Returns the exit code in the form of shells (kInterruptedExit after
  // Interrupt), or -1 if the run was killed (SIGKILL) or did not end.
  int End(std::chrono::seconds deadline) {
    const SteadyTime end = Now() + deadline;
    while (Now() < end) {
      if (const auto status = child_.Poll()) {
        return status->ShellCode() == 128 + SIGKILL ? -1 : status->ShellCode();
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return -1;
  }

  std::string Output() const { return ReadFile(OutputFile(run_)); }
  // Waits until the run has printed the text. Returns false at the deadline.
  bool WaitForOutput(const std::string& text,
                     std::chrono::seconds deadline = std::chrono::seconds(60)) const {
    const SteadyTime end = Now() + deadline;
    while (Output().find(text) == std::string::npos) {
      if (Now() >= end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return true;
  }

 private:
  static ReportReader ReportsFromNowOn(const TrainingRun& run) {
    ReportReader reports(run.path());
    reports.SkipOld();
    return reports;
  }
  static std::filesystem::path OutputFile(const TrainingRun& run) {
    return run.parent() / "output";
  }
  static launch::ProcessSpec Spec(const TrainingRun& run, std::vector<std::string> command,
                                  const Environment& environment) {
    launch::ProcessSpec spec;
    spec.role = "train";
    spec.command = std::move(command);
    spec.command[0] = ProgramPath("shoal");
    spec.output = OutputFile(run);
    spec.environment = environment;
    return spec;
  }
  static int64_t Stored(const nlohmann::json& report) {
    return static_cast<int64_t>(report.value("stored_steps", 0.0));
  }

  const TrainingRun& run_;
  ReportReader reports_;
  launch::ChildProcess child_;
};

// Kills the process of a role and waits for a report of its successor.
inline void KillAndWaitForSuccessor(RunningTraining* training, const std::string& role) {
  const nlohmann::json before = training->reports().WaitFor(role, [](const auto&) { return true; });
  ASSERT_FALSE(before.is_null()) << role;
  const pid_t victim = before.at("pid").get<pid_t>();
  ASSERT_EQ(kill(victim, SIGKILL), 0) << role;
  const nlohmann::json after =
      training->reports().WaitFor(role, [&](const auto& r) { return r.at("pid") != victim; });
  ASSERT_FALSE(after.is_null()) << role << " was not restarted";
}

}  // namespace shoal
