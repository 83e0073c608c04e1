// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/value_bounds.h"

#include <gmock/gmock.h>

#include <functional>

#include "tests/support/error_message.h"

namespace shoal::learner {
namespace {

using ::testing::HasSubstr;

std::string Refusal(const std::function<void(RunConfig*)>& change) {
  RunConfig run;
  run.spec.task = "FetchReach";
  run.config.learner.bounded_targets = true;
  run.config.learner.discount = 0.95;
  change(&run);
  return UsageMessage([&] { CheckValueBounds(run); });
}

TEST(ValueBounds, AreWhatDiscountedSumsOfScaledMinusOnesCanBe) {
  LearnerConfig learner;
  learner.discount = 0.95;
  learner.reward_scale = 2;
  EXPECT_LT(ValueBoundsOf(learner).low, -1e30f);
  learner.bounded_targets = true;
  EXPECT_FLOAT_EQ(ValueBoundsOf(learner).low, -40);
  EXPECT_EQ(ValueBoundsOf(learner).high, 0);
}

TEST(ValueBounds, AreRefusedWhereRewardsAreOthers) {
  EXPECT_EQ(Refusal([](RunConfig*) {}), "");
  EXPECT_THAT(Refusal([](RunConfig* run) { run->spec.task = "FetchReachDense"; }),
              HasSubstr("rewards of task FetchReachDense are not -1 and 0"));
  EXPECT_THAT(Refusal([](RunConfig* run) { run->spec.task = "Hopper-v4"; }),
              HasSubstr("Hopper-v4"));
  EXPECT_THAT(Refusal([](RunConfig* run) { run->config.action_repeat = 2; }),
              HasSubstr("action_repeat = 2"));
  EXPECT_THAT(Refusal([](RunConfig* run) { run->config.learner.discount = 1; }),
              HasSubstr("learner.discount = 1"));
  EXPECT_EQ(Refusal([](RunConfig* run) {
              run->spec.task = "FetchReachDense";
              run->config.learner.bounded_targets = false;
            }),
            "");
}

}  // namespace
}  // namespace shoal::learner
