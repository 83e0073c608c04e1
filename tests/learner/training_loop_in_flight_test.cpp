// SPDX-License-Identifier: Apache-2.0
// The training loop with an agent whose outcomes are known some updates later.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/files.h"
#include "learner/training_loop.h"
#include "tests/learner/training_loop_fixture.h"

namespace shoal::learner {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

// Weights, checkpoints and evaluation points have the bytes of their updates.
TEST_F(TrainingLoopTest, ARunWithUpdatesInFlightSendsAndWritesTheSameBytes) {
  run_.config.learner.checkpoint_period = 3;
  run_.config.eval.interval = 40;  // four updates
  const auto train = [&](size_t delay) {
    delay_ = delay;
    Say(RunState::kRunning);
    Train(11);
    std::map<std::string, std::string> written;
    for (const std::string& name : Checkpoints()) {
      written[name] = ReadFile(Checkpoint(name) / "learner.safetensors");
    }
    fs::remove_all(folder_.path() / "checkpoints");
    EXPECT_EQ(TakeCounted(), 11u);
    EXPECT_EQ(Figure("updates"), 11);
    return std::tuple(written, std::exchange(sink_.weights, {}),
                      std::exchange(sink_.evaluations, {}));
  };
  const auto [written, weights, evaluations] = train(0);
  const auto [late_written, late_weights, late_evaluations] = train(3);
  EXPECT_GE(written.size(), 3u);
  EXPECT_EQ(late_written, written);
  const auto expect_same = [](const auto& sent, const auto& expected) {
    ASSERT_EQ(sent.size(), expected.size());
    ASSERT_FALSE(sent.empty());
    for (size_t i = 0; i < sent.size(); ++i) {
      EXPECT_EQ(sent[i].update, expected[i].update);
      EXPECT_EQ(sent[i].env_steps, expected[i].env_steps);
      EXPECT_TRUE(sent[i].payload == expected[i].payload) << sent[i].update;
    }
  };
  expect_same(late_weights, weights);
  expect_same(late_evaluations, evaluations);
}

// The outcome of update 1 is known when update 4 was submitted. Until then the learner trains on.
TEST_F(TrainingLoopTest, UpdatesContinueWhileWeightsAreOnTheirWay) {
  delay_ = 3;
  std::map<uint64_t, uint64_t> asked;  // the first request after the weights of each update
  Train(12, [&](PlayedBatches& batches) {
    batches.before = [&](uint64_t request) {
      for (const auto& sent : sink_.weights) asked.try_emplace(sent.update, request);
      if (request > 12) Say(RunState::kStopping);
    };
  });
  EXPECT_THAT(asked, ElementsAre(std::pair(1, 5), std::pair(5, 9)));
  EXPECT_THAT(sink_.Updates(sink_.weights), ElementsAre(1, 5, 10)) << "the last ones at the end";
}

TEST_F(TrainingLoopTest, WeightsThatAreDueWaitForThoseOnTheirWay) {
  run_.config.learner.weights_period = 1;
  Train(11);
  const std::vector<KeptMessages::Sent> all = std::exchange(sink_.weights, {});
  ASSERT_EQ(all.size(), 11u);
  fs::remove_all(folder_.path() / "checkpoints");
  delay_ = 3;
  Say(RunState::kRunning);
  Train(11);
  EXPECT_THAT(sink_.Updates(sink_.weights), ElementsAre(1, 4, 7, 10));
  for (const auto& sent : sink_.weights) {
    EXPECT_TRUE(sent.payload == all[sent.update - 1].payload) << sent.update;
    EXPECT_EQ(sent.env_steps, 10 * sent.update);
  }
  EXPECT_EQ(Figure("weights_sent"), 4);
}

// Update 7 is not finite, and the checkpoint, the weights or the evaluation point of update 8 are
// due before its outcome is known otherwise. Only weights let updates continue until it is known.
TEST_F(TrainingLoopTest, NothingLeavesBeforeTheOutcomesOfItsUpdatesAreKnown) {
  const RunConfig plain = run_;
  delay_ = 3;
  const std::pair<std::function<void()>, uint64_t> dues[] = {
      {[this] { run_.config.learner.checkpoint_period = 4; }, 8},
      {[this] { run_.config.learner.weights_period = 8; }, 10},
      {[this] { run_.config.eval.interval = 80; }, 8},
  };
  for (const auto& [due, last] : dues) {
    run_ = plain;
    run_.config.learner.weights_period = 100;
    due();
    uint64_t asked = 0;
    try {
      Train(100, [&](PlayedBatches& batches) {
        batches.poisoned_request = 7;
        batches.before = [&](uint64_t request) { asked = request; };
      });
      FAIL() << "trained on not-a-number";
    } catch (const Error& e) {
      EXPECT_EQ(e.exit_code(), static_cast<int>(ErrorKind::kNonFinite));
      EXPECT_THAT(e.what(), testing::HasSubstr("update 7 is not finite"));
    }
    EXPECT_EQ(asked, last);
    EXPECT_FALSE(Checkpoints().contains("step_000000008"));
    EXPECT_THAT(sink_.Updates(sink_.weights), ElementsAre(1));
    EXPECT_THAT(sink_.evaluations, testing::IsEmpty());
    EXPECT_EQ(TakeCounted(), 6u);
    fs::remove_all(folder_.path() / "checkpoints");
    sink_.weights.clear();
  }
}

TEST_F(TrainingLoopTest, AnIdleLearnerReportsEveryUpdateAndSendsItsWeights) {
  delay_ = 3;
  uint64_t counted = 0;
  size_t sent = 0;
  Train(2, [&](PlayedBatches& batches) {
    batches.last_request = 2;
    int turns = 0;
    batches.before = [&, turns](uint64_t) mutable {
      if (++turns <= 4) return;  // two batches and two turns without one
      counted = TakeCounted();
      sent = sink_.weights.size();
      Say(RunState::kStopping);
    };
  });
  EXPECT_EQ(counted, 2u);
  EXPECT_EQ(sent, 1u);
}

// The actors take no further step before they have the weights.
TEST_F(TrainingLoopTest, InLockstepNoUpdateIsInFlightWhenWeightsAreSent) {
  run_.config.lockstep = true;
  run_.config.envs_per_actor = 2;
  run_.config.lockstep_steps = 6;  // 12 steps, 3 updates per phase
  delay_ = 3;
  Train(10, [&](PlayedBatches& batches) {
    batches.before = [&](uint64_t request) {
      EXPECT_EQ(sink_.weights.size(), (request - 1) / 3) << request;
      if (request > 10) Say(RunState::kStopping);
    };
  });
}

}  // namespace
}  // namespace shoal::learner
