// SPDX-License-Identifier: Apache-2.0
// A run continues while the wall clock is set back and forth.
#include <gtest/gtest.h>

#include "tests/support/running_training.h"

namespace shoal {
namespace {

using nlohmann::json;
using std::chrono::seconds;

TEST(Clock, ARunGoesOnWhileItIsSetBackAndForth) {
  const TrainingRun run;
  const std::filesystem::path skew = run.parent() / "skew";
  const auto set_clock = [&](int offset) { WriteFileAtomically(skew, std::to_string(offset)); };
  set_clock(0);
  RunningTraining training(
      run, run.Command({{"env_steps", "1000000"}, {"actors", "1"}, {"eval.final_episodes", "0"}}),
      {{"LD_PRELOAD", ProgramPath("libshoal_skewed_clock.so")},
       {"SHOAL_CLOCK_SKEW", skew.string()}});
  ASSERT_TRUE(training.WaitForSteps(1500)) << training.Output();
  const double before = training.reports().Await("replay").at("t");
  for (const int offset : {-3600, 7200}) {
    set_clock(offset);
    ASSERT_TRUE(training.WaitForMoreSteps(500)) << training.Output();
    const double updates = training.reports().Await("learner").at("updates");
    EXPECT_FALSE(
        training.reports()
            .WaitFor("learner", [&](const json& r) { return r.at("updates") > updates + 10; })
            .is_null())
        << training.Output();
  }
  const double after = training.reports().Await("replay").at("t");
  EXPECT_GT(after - before, 7000) << "the clock of the processes was not set";
  training.Interrupt();
  ASSERT_EQ(training.End(seconds(120)), kInterruptedExit) << training.Output();
  ExpectBalanced(run.Json("meta.json"));
}

}  // namespace
}  // namespace shoal
