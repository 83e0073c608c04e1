// SPDX-License-Identifier: Apache-2.0
// The training loop with rollouts in place of batches.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/learner/training_loop_fixture.h"

namespace shoal::learner {
namespace {

using testing::ElementsAre;

class OnPolicyLoopTest : public TrainingLoopTest {
 protected:
  OnPolicyLoopTest() {
    run_.config.learner.algorithm = "ppo";
    run_.config.ppo.epochs = 1;
    run_.config.env_steps = 30;  // a batch brings 10
    run_.spec.drawn_actions = true;
  }
};

TEST_F(OnPolicyLoopTest, GivesTheWeightsBeforeTheFirstUpdateAndAfterEachOne) {
  Train(2);
  EXPECT_THAT(sink_.Updates(sink_.weights), ElementsAre(0, 1, 2));
}

TEST_F(OnPolicyLoopTest, GivesNoWeightsBeyondTheBudgetUnlessItIsRaised) {
  Train(3);
  EXPECT_THAT(sink_.Updates(sink_.weights), ElementsAre(0, 1, 2));
  EXPECT_EQ(sink_.progress.back().env_steps, 30u);
  sink_.weights.clear();
  Say(RunState::kRunning);
  Train(5, [&](PlayedBatches& batches) {
    batches.before = [&](uint64_t request) {
      if (request > 5) return Say(RunState::kStopping);
      control_.OnMessage({.epoch = ++epoch_,
                          .state = RunState::kRunning,
                          .time = 0,
                          .setting_names = {"env_steps"},
                          .setting_values = {60}},
                         Now());
    };
  });
  // A learner restored beyond its budget trains on no rollout until the budget is raised.
  EXPECT_THAT(sink_.Updates(sink_.weights), ElementsAre(4, 5));
}

TEST_F(OnPolicyLoopTest, WeightsThatTheTransportDidNotTakeAreSentAgain) {
  sink_.accept_weights = false;
  int turns = 0;
  Train(1, [&](PlayedBatches& batches) {
    batches.last_request = 0;
    batches.before = [&](uint64_t) {
      if (++turns == 3) sink_.accept_weights = true;
      if (turns == 6) Say(RunState::kStopping);
    };
  });
  EXPECT_THAT(sink_.Updates(sink_.weights), ElementsAre(0));
}

// It may take longer than a process may be silent.
TEST_F(OnPolicyLoopTest, ReportsInTheMidstOfAnUpdate) {
  slow_ = true;
  Train(1);
  const MetricsMessage& first = sink_.reports.front();
  const auto updates = std::ranges::find(first.names, "updates");
  ASSERT_NE(updates, first.names.end());
  EXPECT_EQ(first.values[size_t(updates - first.names.begin())], 0) << "the first is not over";
  EXPECT_EQ(first.state, "running");
}

TEST_F(OnPolicyLoopTest, DrainsAtOnce) {
  uint64_t drained_at = 0;
  Train(50, [&](PlayedBatches& batches) {
    batches.before = [&](uint64_t request) {
      if (request == 2) {
        drained_at = request;
        Say(RunState::kDraining);
      }
    };
    sink_.on_evaluation = [&] { Say(RunState::kStopping); };
  });
  EXPECT_EQ(drained_at, 2u);
  EXPECT_EQ(updates_, 2u) << "the batch that it had, no more";
  EXPECT_TRUE(sink_.progress.back().drained);
}

}  // namespace
}  // namespace shoal::learner
