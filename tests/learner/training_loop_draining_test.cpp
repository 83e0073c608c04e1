// SPDX-License-Identifier: Apache-2.0
// The training loop when the run drains: the learner makes the updates that are still granted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "learner/training_loop.h"
#include "tests/learner/training_loop_fixture.h"

namespace shoal::learner {
namespace {

using testing::ElementsAre;

TEST_F(TrainingLoopTest, DrainingEndsWithTheUpdatesThatTheStoredStepsGrant) {
  // 48 steps are stored when draining begins: (48 - 8) * 1 samples are granted, 10 batches of 4.
  sink_.on_evaluation = [this] { Say(RunState::kStopping); };
  Train(1000, [&](PlayedBatches& batches) {
    batches.stored_steps = [](uint64_t request) { return request < 3 ? 12 * request : 48; };
    batches.before = [this](uint64_t request) {
      if (request == 3) Say(RunState::kDraining);
    };
  });
  EXPECT_EQ(updates_, 10u);
  EXPECT_THAT(sink_.Updates(sink_.evaluations), ElementsAre(10));
  EXPECT_TRUE(Checkpoints().contains("step_000000010"));
}

// 12 of the 48 stored steps cannot be sampled: (36 - 8) * 1 samples, 7 batches of 4.
TEST_F(TrainingLoopTest, DrainingGrantsNothingForStepsThatNoSampleBeginsWith) {
  sink_.on_evaluation = [this] { Say(RunState::kStopping); };
  Train(1000, [&](PlayedBatches& batches) {
    batches.unsampleable_steps = 12;
    batches.stored_steps = [](uint64_t request) { return request < 3 ? 12 * request : 48; };
    batches.before = [this](uint64_t request) {
      if (request == 3) Say(RunState::kDraining);
    };
  });
  EXPECT_EQ(updates_, 7u);
}

// Steps 8 to 48 of a line from 3 at step 0 to 1 at step 40: 32 (2.6 + 1) / 2 + 8 = 65.6 samples are
// granted, 17 batches of 4.
TEST_F(TrainingLoopTest, DrainingEndsWithTheUpdatesThatAScheduleGrants) {
  run_.config.replay.samples_per_insert = Schedule{3, 1, 40};
  sink_.on_evaluation = [this] { Say(RunState::kStopping); };
  Train(1000, [&](PlayedBatches& batches) {
    batches.stored_steps = [](uint64_t request) { return request < 3 ? 12 * request : 48; };
    batches.before = [this](uint64_t request) {
      if (request == 3) Say(RunState::kDraining);
    };
  });
  EXPECT_EQ(updates_, 17u);
  EXPECT_EQ(Figure("samples_per_insert"), 1);
}

TEST_F(TrainingLoopTest, AResumedLearnerDrainsByTheWholeSchedule) {
  run_.config.replay.samples_per_insert = Schedule{3, 1, 40};
  const auto stored = [](uint64_t request) { return std::min<uint64_t>(6 * request, 48); };
  Train(4, [&](PlayedBatches& batches) { batches.stored_steps = stored; });
  ASSERT_EQ(updates_, 4u);
  sink_.on_evaluation = [this] { Say(RunState::kStopping); };
  Say(RunState::kRunning);
  Train(1000, [&](PlayedBatches& batches) {
    batches.stored_steps = stored;
    batches.before = [this](uint64_t request) {
      if (request == 9) Say(RunState::kDraining);
    };
  });
  EXPECT_EQ(updates_, 17u);
}

// At step 28 the number 0.6 takes the schedule's place: 20 (2.6 + 1.6) / 2 + 20 * 0.6 = 54 samples.
TEST_F(TrainingLoopTest, WhatIsSetTakesTheSchedulesPlaceFromThereOn) {
  run_.config.replay.samples_per_insert = Schedule{3, 1, 40};
  sink_.on_evaluation = [this] { Say(RunState::kStopping); };
  const auto say = [this](RunState state) {
    control_.OnMessage({.epoch = ++epoch_,
                        .state = state,
                        .time = 0,
                        .setting_names = {"replay.samples_per_insert"},
                        .setting_values = {0.6}},
                       Now());
  };
  Train(1000, [&](PlayedBatches& batches) {
    batches.stored_steps = [](uint64_t request) {
      return request < 4 ? std::min<uint64_t>(14 * request, 28) : 48;
    };
    batches.before = [&](uint64_t request) {
      if (request == 3) say(RunState::kRunning);
      if (request == 5) say(RunState::kDraining);
    };
  });
  EXPECT_EQ(updates_, 14u);
}

TEST_F(TrainingLoopTest, DrainingEndsWhenNoMoreBatchesCome) {
  sink_.on_evaluation = [this] { Say(RunState::kStopping); };
  Train(6, [&](PlayedBatches& batches) {
    batches.before = [this](uint64_t request) {
      if (request == 5) Say(RunState::kDraining);
    };
  });
  EXPECT_THAT(sink_.Updates(sink_.evaluations), ElementsAre(6));
}

TEST_F(TrainingLoopTest, ADrainedLearnerTrainsNoMoreAndSaysSo) {
  run_.config.replay.samples_per_insert =
      Schedule::Constant(0);     // no limit: three more batches report stored records
  sink_.reject_evaluations = 2;  // sent in the second pass after draining was over
  sink_.on_evaluation = [this] { Say(RunState::kStopping); };
  Train(1000, [&](PlayedBatches& batches) {
    batches.before = [this](uint64_t request) {
      if (request == 5) Say(RunState::kDraining);
    };
  });
  EXPECT_EQ(given_, 8u) << "the one being waited for when draining began, and three more";
  EXPECT_THAT(sink_.Updates(sink_.evaluations), ElementsAre(8));
  EXPECT_EQ(Figure("drained"), 1);
  EXPECT_EQ(Figure("eval_updates"), 8);
}

}  // namespace
}  // namespace shoal::learner
