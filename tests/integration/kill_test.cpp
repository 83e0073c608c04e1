// SPDX-License-Identifier: Apache-2.0
// SIGKILL of each role while training: the run goes on, nothing acknowledged is lost, the account
// balances exactly.
#include <gtest/gtest.h>
#include <signal.h>

#include "tests/support/running_training.h"

namespace shoal {
namespace {

using nlohmann::json;
using std::chrono::seconds;

// Updates are lost with a learner that is killed now, whatever else is under way.
bool FarFromCheckpoints(const json& report) {
  const int64_t since = report.at("updates").get<int64_t>() % 2000;
  return since > 200 && since < 1500;
}

TEST(Kill, TrainingSurvivesTheDeathOfEachRole) {
  const TrainingRun run;
  RunningTraining training(
      run, run.Command({{"env_steps", "10000000"},
                        {"actors", "2"},
                        {"eval.interval", "10000000"},  // of no evaluation a checkpoint
                        {"learner.checkpoint_period", "2000"}}));
  ASSERT_TRUE(training.WaitForMoreSteps(1500)) << training.Output();
  for (const char* role : {"actor", "replay", "learner", "eval"}) {
    if (role == std::string("learner")) {
      ASSERT_FALSE(training.reports().WaitFor(role, FarFromCheckpoints).is_null());
    }
    KillAndWaitForSuccessor(&training, role);
    ASSERT_TRUE(training.WaitForMoreSteps(500)) << role << ": " << training.Output();
  }
  // Not by its budget, which a fast machine would reach before the last kill.
  training.Interrupt();
  ASSERT_EQ(training.End(seconds(120)), kInterruptedExit) << training.Output();
  const json meta = run.Json("meta.json");
  ExpectBalanced(meta);
  EXPECT_EQ(meta.at("accounting").at("rejected"), 0);
  EXPECT_GT(meta.at("updates_lost").get<int64_t>(), 0) << "those since the learner's checkpoint";
  // Only an actor's death loses records, and only those not yet acknowledged: its window.
  EXPECT_LE(meta.at("accounting").at("lost_with_process").get<int64_t>(), 4 * 24);
}

}  // namespace
}  // namespace shoal
