// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/experiment_run_status.h"

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "launch/record/run_folder.h"
#include "launch/tools/experiment/process_runner.h"
#include "launch/tools/experiment/run_results.h"
#include "tests/launch/tools/experiment/planted_run.h"

namespace shoal::launch {
namespace {

LoggedRun Ended(int code, bool by_signal = false, bool stopped = false) {
  LoggedRun logged{.starts = 1};
  logged.ending = RunEnding{
      .run = "run", .by_signal = by_signal, .code = code, .stopped = stopped, .problem = "why"};
  return logged;
}

TEST(ExperimentRunStatus, WithoutAConfigurationItHasNotBegun) {
  const PlantedRun run;
  EXPECT_EQ(StandingOf(run.path(), nullptr).standing, ExperimentRunStatus::kMissing);
  const LoggedRun refused = Ended(2), killed = Ended(9, true), stopped = Ended(1, false, true),
                  interrupted = Ended(130);
  EXPECT_EQ(StandingOf(run.path(), &refused).standing, ExperimentRunStatus::kFailed);
  EXPECT_EQ(StandingOf(run.path(), &refused).problem, "why");
  EXPECT_EQ(StandingOf(run.path(), &killed).standing, ExperimentRunStatus::kMissing);
  EXPECT_EQ(StandingOf(run.path(), &stopped).standing, ExperimentRunStatus::kMissing);
  EXPECT_EQ(StandingOf(run.path(), &interrupted).standing, ExperimentRunStatus::kMissing)
      << "by Ctrl-C";
}

TEST(ExperimentRunStatus, FinishedIsTrainedAndEvaluated) {
  PlantedRun run;
  run.Begin();
  EXPECT_EQ(StandingOf(run.path(), nullptr).standing, ExperimentRunStatus::kInterrupted);
  run.WriteMeta("budget");
  EXPECT_EQ(StandingOf(run.path(), nullptr).standing, ExperimentRunStatus::kInterrupted)
      << "its last evaluation is still to come";
  run.WriteFinal(0.9, 10);
  EXPECT_EQ(StandingOf(run.path(), nullptr).standing, ExperimentRunStatus::kFinished);
  run.WriteMeta("target");
  EXPECT_EQ(StandingOf(run.path(), nullptr).standing, ExperimentRunStatus::kFinished);
}

TEST(ExperimentRunStatus, FinishedIsEvaluatedOnEveryFurtherTask) {
  PlantedRun run;
  run.Begin();
  run.WriteMeta("budget");
  run.WriteFinal(0.9, 10);
  const std::vector<std::string> transfer{"FetchReachDense", "FetchReach", "FetchPush"};
  const auto standing = [&](const LoggedRun* logged) {
    return StandingOf(run.path(), logged, transfer);
  };
  EXPECT_EQ(standing(nullptr).standing, ExperimentRunStatus::kInterrupted);
  EXPECT_EQ(standing(nullptr).missing_transfers,
            (std::vector<std::string>{"FetchReach", "FetchPush"}))
      << "its own task was evaluated at its end";
  const auto evaluation = PlantedEvaluation(1000, 0.5, 10).dump();
  WriteFileAtomically(TransferFile(run.path(), "FetchReach"), evaluation);
  const LoggedRun failed = Ended(1), stopped = Ended(1, false, true), killed = Ended(9, true);
  EXPECT_EQ(standing(&failed).standing, ExperimentRunStatus::kFailed);
  EXPECT_EQ(standing(&failed).problem, "why");
  EXPECT_EQ(standing(&failed).missing_transfers, std::vector<std::string>{"FetchPush"});
  EXPECT_EQ(standing(&stopped).standing, ExperimentRunStatus::kInterrupted);
  EXPECT_EQ(standing(&killed).standing, ExperimentRunStatus::kInterrupted);
  WriteFileAtomically(TransferFile(run.path(), "FetchPush"), evaluation);
  EXPECT_EQ(standing(nullptr).standing, ExperimentRunStatus::kFinished);
}

TEST(ExperimentRunStatus, StoppedOrKilledGoesOn) {
  PlantedRun run;
  run.Begin();
  for (const char* exit : {"running", "interrupted"}) {
    run.WriteMeta(exit);
    const LoggedRun killed = Ended(9, true), stopped = Ended(1, false, true), alive{.starts = 1};
    for (const LoggedRun* logged : {&killed, &stopped, &alive}) {
      EXPECT_EQ(StandingOf(run.path(), logged).standing, ExperimentRunStatus::kInterrupted) << exit;
    }
    const LoggedRun refused = Ended(1);
    EXPECT_EQ(StandingOf(run.path(), &refused).standing, ExperimentRunStatus::kFailed) << exit;
  }
}

TEST(ExperimentRunStatus, FailedSaysWhy) {
  PlantedRun run;
  run.Begin();
  run.WriteMeta("failed", "the disk is full");
  EXPECT_EQ(StandingOf(run.path(), nullptr).standing, ExperimentRunStatus::kFailed);
  EXPECT_EQ(StandingOf(run.path(), nullptr).problem, "the disk is full");
}

TEST(ExperimentRunStatus, ABrokenFileIsAFailureThatNamesIt) {
  PlantedRun run;
  run.Begin();
  WriteFileAtomically(run.path() / "meta.json", "{\"exit\":");
  const StandingReport report = StandingOf(run.path(), nullptr);
  EXPECT_EQ(report.standing, ExperimentRunStatus::kFailed);
  EXPECT_NE(report.problem.find("meta.json"), std::string::npos) << report.problem;
}

TEST(ExperimentRunStatus, AHeldRunIsRunning) {
  const TemporaryFolder folder;
  const RunFolder held = RunFolder::Create(folder.path(), "run", false);
  EXPECT_EQ(StandingOf(held.path(), nullptr).standing, ExperimentRunStatus::kRunning);
}

TEST(SplitCores, GivesEachRunItsOwn) {
  using Cores = std::vector<std::vector<int>>;
  EXPECT_EQ(SplitCores({0, 1, 4, 5, 6}, 2), (Cores{{0, 1, 4}, {5, 6}}));
  EXPECT_EQ(SplitCores({2, 3}, 2), (Cores{{2}, {3}}));
  EXPECT_THROW(SplitCores({0, 1}, 3), Error);
  EXPECT_GE(OwnCores().size(), 1u);
}

}  // namespace
}  // namespace shoal::launch
