// SPDX-License-Identifier: Apache-2.0
// A hanging process is detected, killed and replaced, and the account balances.
#include <gtest/gtest.h>
#include <signal.h>

#include "launch/processes/supervisor.h"
#include "tests/support/running_training.h"
#include "tests/support/slow_point.h"

namespace shoal {
namespace {

using nlohmann::json;
using std::chrono::seconds;

TEST(Hang, AStoppedProcessOfEachServerIsReplacedWithinTheDocumentedTime) {
  const TrainingRun run;
  RunningTraining training(
      run, run.Command(SlowPoint(
               {{"env_steps", "1000000"}, {"actors", "2"}, {"eval.final_episodes", "0"}})));
  ASSERT_TRUE(training.WaitForSteps(1500)) << training.Output();
  // At once, so that the test waits for one silence: a learner and an actor.
  const std::string roles[] = {"learner", "actor"};
  pid_t hung[2];
  for (int i = 0; i < 2; ++i) {
    const json report = training.reports().WaitFor(roles[i], [](const json&) { return true; });
    ASSERT_FALSE(report.is_null()) << roles[i] << ": " << training.Output();
    hung[i] = report.at("pid").get<pid_t>();
    ASSERT_EQ(kill(hung[i], SIGSTOP), 0);
  }
  const SteadyTime start = Now();
  for (int i = 0; i < 2; ++i) {
    const json successor = training.reports().WaitFor(
        roles[i], [&](const json& r) { return r.at("pid") != hung[i]; },
        launch::HangLimits().report + seconds(30));
    EXPECT_FALSE(successor.is_null()) << roles[i] << ": " << training.Output();
  }
  EXPECT_GE(SecondsSince(start), 25) << "not taken for hung too early";
  EXPECT_TRUE(training.WaitForMoreSteps(1000)) << training.Output();
  training.Interrupt();
  ASSERT_EQ(training.End(seconds(120)), kInterruptedExit) << training.Output();
  const std::string output = training.Output();
  for (const char* line : {"learner-0", "hangs: no report for 30 s; killed", "actor-0"}) {
    EXPECT_NE(output.find(line), std::string::npos) << output;
  }
  ExpectBalanced(run.Json("meta.json"));
}

}  // namespace
}  // namespace shoal
