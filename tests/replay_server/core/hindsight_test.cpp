// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/hindsight.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

#include "common/base/aligned_bytes.h"
#include "common/tasks/task_registry.h"
#include "replay_server/core/replay_core.h"
#include "tests/replay_server/record_script.h"
#include "tests/support/error_message.h"

namespace shoal::replay {
namespace {

using testing::HasSubstr;

constexpr int kEpisode = 50;  // env steps of a Fetch task

// FetchPush from state, small.
RunConfig PushRun() {
  RunConfig run = TinyRun(/*stack=*/1, /*capacity=*/2000);
  run.spec = {};
  run.spec.task = run.config.task = "FetchPush";
  run.spec.blocks = {{"grip", 3}, {"achieved_goal", 3, /*observed=*/false}, {"desired_goal", 3}};
  run.spec.action_size = 2;
  run.config.observation.pixels = false;
  run.config.observation.goal_mode = "desired";
  run.config.envs_per_actor = 2;
  run.config.replay.hindsight = "future";
  run.config.replay.min_size = 100;
  run.config.replay.samples_per_insert = Schedule::Constant(4);
  run.config.learner.batch = 16;
  return run;
}

// The records of an actor with two environments that step in turn, in episodes of full length. The
// achieved goal moves along a line, so that some hindsight goals are near and some are far.
std::vector<uint8_t> PushRecord(const RunConfig& run, uint64_t sequence) {
  const uint64_t round = (sequence - 1) / 2;  // each environment makes a record
  const auto env = static_cast<uint32_t>((sequence - 1) % 2);
  const auto index = static_cast<uint32_t>(round % (kEpisode + 1));
  const uint8_t flags = index == kEpisode ? kTruncated : 0;
  auto record = MakeRecord(run.spec, 0, env, static_cast<uint32_t>(round / (kEpisode + 1)), index,
                           sequence, flags);
  const auto vector = RecordLayout(run.spec).Vector(record.data());
  vector[3] = 0.01f * static_cast<float>(index);
  vector[4] = vector[5] = 0;
  return record;
}

class HindsightTest : public testing::Test {
 protected:
  void Start() { core_.emplace(run_, "", 1); }

  // Sends up to `count` records, as far as credit goes; returns how many.
  uint64_t Send(uint64_t count) {
    std::vector<uint8_t> payload;
    uint64_t sent = 0;
    TakeCredits();
    while (sent < count && next_ <= allowed_) {
      payload = PushRecord(run_, next_);
      core_->TakeChunk({.spec_hash = run_.spec.Hash(),
                        .actor = 0,
                        .count = 1,
                        .session = 5,
                        .first_sequence = next_,
                        .payload = payload});
      ++next_, ++sent;
      TakeCredits();
    }
    return sent;
  }
  void TakeCredits() {
    for (const Credit& credit : core_->TakeCredits(true)) allowed_ = credit.allowed;
  }

  // The next batch; nothing when it must wait.
  std::optional<BatchView> Draw() {
    const BatchSchema& schema = core_->batch_schema();
    if (!asked_) {
      core_->TakeRequest({.spec_hash = run_.spec.Hash(),
                          .learner_session = 1,
                          .request = ++request_,
                          .batch = static_cast<uint32_t>(run_.config.learner.batch),
                          .schema_hash = schema.Hash()});
    }
    asked_ = true;
    memory_ = AlignedBytes(schema.total_bytes());
    if (!core_->TryAnswer(memory_.data())) return std::nullopt;
    asked_ = false;
    return schema.View(memory_.data());
  }

  RunConfig run_ = PushRun();
  std::optional<ReplayCore> core_;
  uint64_t next_ = 1, allowed_ = 1, request_ = 0;
  bool asked_ = false;
  AlignedBytes memory_;
};

TEST_F(HindsightTest, NothingIsSampledBeforeAnEpisodeHasEnded) {
  run_.config.replay.min_size = 1;
  Start();
  Send(2 * kEpisode);  // both environments lack their last step
  EXPECT_EQ(core_->index().sampleable(), 0u);
  EXPECT_FALSE(Draw());
  Send(1);
  EXPECT_EQ(core_->index().sampleable(), uint64_t{kEpisode});
  EXPECT_TRUE(Draw());
}

TEST_F(HindsightTest, RelabelledRewardsAreThoseOfTheTaskForTheGoalThatIsShown) {
  Start();
  Send(2 * 3 * (kEpisode + 1));
  const tasks::Task task = TaskOf(run_);
  int relabelled = 0, reached = 0;
  for (int i = 0; i < 20; ++i) {
    const auto view = Draw();
    ASSERT_TRUE(view);
    for (size_t b = 0; b < view->reward.size(); ++b) {
      const auto& element = core_->last_plan().elements[b];
      if (element.goal == 0) continue;
      ++relabelled;
      const auto goal = view->next_obs_vector.subspan(b * 6 + 3, 3);
      const auto achieved = core_->ring().layout().Vector(core_->ring().Record(element.id));
      ASSERT_EQ(view->reward[b], task.Reward(task.Distance(achieved.subspan(3, 3), goal)));
      ASSERT_TRUE(std::ranges::equal(goal, view->obs_vector.subspan(b * 6 + 3, 3)));
      reached += view->reward[b] == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(relabelled, 100);
  EXPECT_GT(reached, 10);
  EXPECT_LT(reached, relabelled);
  EXPECT_EQ(core_->counters().relabelled, static_cast<uint64_t>(relabelled));
  EXPECT_GE(core_->counters().zero_rewards, static_cast<uint64_t>(reached));
}

// Own goals are out of reach of the script, so what ends an episode early is a goal of hindsight.
TEST_F(HindsightTest, WhereEpisodesEndOnSuccessTheStepThatReachesTheGoalEndsTheSample) {
  for (const bool end_on_success : {false, true}) {
    run_.config.end_on_success = end_on_success;
    run_.config.replay.n_step = 8;
    next_ = allowed_ = 1;
    request_ = 0;
    Start();
    Send(2 * 3 * (kEpisode + 1));
    const Ring& ring = core_->ring();
    const tasks::Task task = TaskOf(run_);
    int ended = 0;
    for (int i = 0; i < 20; ++i) {
      const auto view = Draw();
      ASSERT_TRUE(view);
      for (size_t b = 0; b < view->reward.size(); ++b) {
        const auto& element = core_->last_plan().elements[b];
        if (element.goal == 0) continue;
        const auto achieved = [&](uint64_t id) {
          return ring.layout().Vector(ring.Record(id)).subspan(3, 3);
        };
        // Environments step in turn: the next step of an episode is two records on.
        uint64_t last = element.id;
        const auto reached = [&] {
          return task.Success(task.Distance(achieved(last), achieved(element.goal)));
        };
        int steps = 1;
        for (; steps < 8 && !(end_on_success && reached()); ++steps) last += 2;
        const bool ends = end_on_success && reached();
        ended += ends ? 1 : 0;
        const double discount = run_.config.learner.discount;
        ASSERT_FLOAT_EQ(view->bootstrap[b],
                        ends ? 0 : static_cast<float>(std::pow(discount, steps - 1)));
        ASSERT_EQ(view->next_obs_vector[b * 6], ring.layout().Vector(ring.Record(last))[0]);
      }
    }
    EXPECT_EQ(ended > 10, end_on_success);
  }
}

TEST_F(HindsightTest, AShareOfTheSamplesIsRelabelled) {
  for (const int goals : {0, 1, 4}) {
    run_.config.replay.hindsight_goals = goals;
    run_.config.replay.samples_per_insert = Schedule::Constant(0);
    next_ = allowed_ = 1;
    request_ = 0;
    Start();
    Send(2 * (kEpisode + 1));
    constexpr int kBatches = 500;
    for (int i = 0; i < kBatches; ++i) ASSERT_TRUE(Draw());
    const double n = kBatches * run_.config.learner.batch, p = goals / (goals + 1.0);
    const auto relabelled = static_cast<double>(core_->counters().relabelled);
    EXPECT_NEAR(relabelled, n * p, 5 * std::sqrt(n * p * (1 - p))) << goals;
  }
}

// Whole episodes become sampleable at once: the band must hold them, or samples would be lost.
TEST_F(HindsightTest, SamplesPerInsertComeOutAsAsked) {
  Start();
  uint64_t drawn_before = 0, became_before = 0;
  for (int turn = 0; turn < 6'000; ++turn) {
    Send(1 + static_cast<uint64_t>(turn) % 7);
    if (turn % 2 == 0) Draw();
    if (turn == 200) {
      drawn_before = core_->counters().batches;
      became_before = core_->index().became_sampleable();
    }
  }
  const double drawn =
      static_cast<double>(core_->counters().batches - drawn_before) * run_.config.learner.batch;
  const auto became = static_cast<double>(core_->index().became_sampleable() - became_before);
  EXPECT_GT(became, 10'000);
  EXPECT_NEAR(drawn / became, 4, 4 * 0.02);
}

TEST_F(HindsightTest, FutureGoalsAreSpreadOverWhatIsLeftOfTheEpisode) {
  Start();
  Send(2 * (kEpisode + 1));
  HindsightRelabeller relabeller(core_->ring(), core_->index(), HindsightGoal::kFuture, 1000);
  Random random(3);
  // Environment 0: ids 1, 3, ..., 101; step 41 has 10 steps from itself to the end.
  std::map<uint64_t, int> counts;
  constexpr int kDraws = 20'000;
  int drawn = 0;
  for (int i = 0; i < kDraws; ++i) {
    const uint64_t goal = relabeller.DrawGoal(2 * 41 + 1, &random);
    if (goal == 0) continue;
    ++counts[goal], ++drawn;
  }
  ASSERT_EQ(counts.size(), 10u);
  EXPECT_EQ(counts.begin()->first, 2u * 41 + 1) << "the step itself";
  EXPECT_EQ(counts.rbegin()->first, 2u * kEpisode + 1);
  for (const auto& [id, count] : counts) {
    EXPECT_NEAR(count, drawn / 10.0, 5 * std::sqrt(drawn * 0.09)) << id;
  }
}

std::string Refusal(const std::function<void(RunConfig&)>& change) {
  RunConfig run = PushRun();
  change(run);
  return UsageMessage([&] { CheckHindsight(run); });
}

TEST_F(HindsightTest, WhatItCannotServeIsRefusedByName) {
  EXPECT_EQ(Refusal([](RunConfig&) {}), "");
  EXPECT_THAT(Refusal([](RunConfig& r) { r.spec.task = "Hopper-v4"; }),
              HasSubstr("task Hopper-v4 has no goals"));
  EXPECT_THAT(Refusal([](RunConfig& r) { r.config.action_repeat = 2; }),
              HasSubstr("action_repeat = 2"));
  EXPECT_THAT(Refusal([](RunConfig& r) {
                r.config.observation.goal_mode = "none";
                r.spec.blocks[2].observed = false;
              }),
              HasSubstr("observation.goal_mode = none"));
  EXPECT_THAT(Refusal([](RunConfig& r) { r.config.replay.capacity = 305; }),
              HasSubstr("expected at least 306"));
  EXPECT_EQ(Refusal([](RunConfig& r) { r.config.replay.capacity = 306; }), "");
  EXPECT_THAT(Refusal([](RunConfig& r) {  // a goal record for each episode
                r.spec.goal_picture = true;
                r.spec.blocks[2].observed = false;
                r.config.replay.capacity = 311;
              }),
              HasSubstr("expected at least 312"));
  EXPECT_THAT(Refusal([](RunConfig& r) {  // 41 first steps an episode: 3 episodes and 4
                r.config.replay.capacity = 356;
                r.config.replay.n_step = 10;
              }),
              HasSubstr("expected at least 357"));
  // If episodes end on success, each may have one step and its reset: 2 x 100 and 4 whole ones.
  EXPECT_THAT(Refusal([](RunConfig& r) {
                r.config.end_on_success = true;
                r.config.replay.capacity = 403;
              }),
              HasSubstr("expected at least 404"));
  EXPECT_THAT(Refusal([](RunConfig& r) { r.config.replay.n_step = 51; }),
              HasSubstr("replay.n_step = 51: an episode of FetchPush has 50 steps"));
  EXPECT_THAT(Refusal([](RunConfig& r) {
                r.config.lockstep = true;
                r.config.replay.min_size = 99;
              }),
              HasSubstr("in lockstep: after replay.min_size = 99"));
  EXPECT_THAT(Refusal([](RunConfig& r) {
                r.config.replay.hindsight = "none";
                r.config.replay.movement_share = 0.5;
              }),
              HasSubstr("replay.movement_share = 0.5 with replay.hindsight = none"));
}

TEST_F(HindsightTest, TheRunsThresholdHolds) {
  run_.config.distance_threshold = 0.2;
  EXPECT_EQ(TaskOf(run_).distance_threshold(), 0.2);
  run_.config.distance_threshold = 0;
  EXPECT_EQ(TaskOf(run_).distance_threshold(), 0.05);
}

}  // namespace
}  // namespace shoal::replay
