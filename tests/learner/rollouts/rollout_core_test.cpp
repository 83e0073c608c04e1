// SPDX-License-Identifier: Apache-2.0
#include "learner/rollouts/rollout_core.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "common/base/aligned_bytes.h"
#include "tests/learner/rollouts/actor_script.h"

namespace shoal::learner {
namespace {

class RolloutCoreTest : public testing::Test {
 protected:
  RolloutCoreTest() { Restart(100); }
  void Restart(uint64_t session, const RunAccount& before = {}) {
    core_ = std::make_unique<RolloutCore>(run_, session, before);
    core_->SetActors(2);
    core_->Await({session, 0});
  }
  BatchView TakeReady() {
    schema_.emplace(core_->ReadySchema());
    memory_ = AlignedBytes(schema_->total_bytes());
    core_->TakeReady(*schema_, memory_.data());
    return schema_->View(memory_.data());
  }
  SessionCounters Counters(uint32_t actor, uint64_t session) const {
    return core_->sessions().at(*core_->sessions().Find(actor, session));
  }

  RunConfig run_ = PpoRun(2);
  std::unique_ptr<RolloutCore> core_;
  std::optional<BatchSchema> schema_;
  AlignedBytes memory_;
  ActorScript a_{PpoSpec(), 0, 10}, b_{PpoSpec(), 1, 11};
};

TEST_F(RolloutCoreTest, ARolloutHasWhatWasSeenDoneAndEarned) {
  a_.PlayThree(0, 0);
  b_.PlayThree(1, 0);
  EXPECT_EQ(core_->TakeChunk(b_.Chunk()).stored, 4u);
  EXPECT_EQ(core_->Ready(), 1);
  core_->TakeChunk(a_.Chunk());
  ASSERT_EQ(core_->Ready(), core_->Expected());
  const BatchView batch = TakeReady();
  ASSERT_EQ(batch.reward.size(), 6u);
  for (size_t t = 0; t < 6; ++t) {
    const float at = float(t % 3 + 1);
    EXPECT_EQ(batch.id[t], t / 3) << "environments in order, not by arrival";
    EXPECT_EQ(batch.obs_vector[3 * t], at);
    EXPECT_EQ(batch.reward[t], at + 1);
    EXPECT_EQ(batch.log_prob[t], -at - 1);
    EXPECT_EQ(batch.drawn_action[2 * t], 2 * (at + 1));
    EXPECT_EQ(batch.bootstrap[t], 1);
    EXPECT_EQ(batch.continues[t], t % 3 < 2 ? 1 : 0);
    EXPECT_EQ(batch.ends[t], 0);
  }
  EXPECT_EQ(batch.next_obs_vector[3 * 2], 4) << "where the rollout's value is bootstrapped";
  EXPECT_EQ(core_->stored_steps(), 6u);
  EXPECT_EQ(core_->used_records(), 8u);
  EXPECT_EQ(Counters(0, 10).stored(), 4u);
  EXPECT_EQ(Counters(0, 10).discarded, 0u);
}

TEST_F(RolloutCoreTest, GoesOnOverTheEndsOfEpisodes) {
  a_.Reset(0, 0, 1);
  a_.Step(0, 0, 1, 2, kFirst, kTerminated);
  a_.Reset(0, 1, 5);
  a_.Step(0, 1, 1, 6, kFirst, kTruncated);
  a_.Reset(0, 2, 8);
  a_.Step(0, 2, 1, 9);
  core_->TakeChunk(a_.Chunk());
  const BatchView batch = TakeReady();
  EXPECT_EQ(batch.obs_vector[0], 1);
  EXPECT_EQ(batch.obs_vector[3], 5);
  EXPECT_EQ(batch.obs_vector[6], 8);
  EXPECT_EQ(std::vector<float>(batch.bootstrap.begin(), batch.bootstrap.end()),
            (std::vector<float>{0, 1, 1}));
  EXPECT_EQ(std::vector<float>(batch.ends.begin(), batch.ends.end()),
            (std::vector<float>{1, 1, 0}));
  EXPECT_EQ(batch.next_obs_vector[3], 6) << "the time limit's true last observation";
  EXPECT_EQ(core_->used_records(), 6u) << "resets too";
}

// A faulty episode ends without a mark on its last step.
TEST_F(RolloutCoreTest, AnEpisodeThatBreaksOffIsTruncatedAtItsLastObservation) {
  a_.Reset(0, 0, 1);
  a_.Step(0, 0, 1, 2);
  a_.Step(0, 0, 2, 3);
  a_.Reset(0, 1, 5);
  a_.Step(0, 1, 1, 6);
  core_->TakeChunk(a_.Chunk());
  ASSERT_EQ(core_->Ready(), 1) << "the rollout is whole";
  const BatchView batch = TakeReady();
  EXPECT_EQ(batch.obs_vector[3], 2);
  EXPECT_EQ(batch.obs_vector[6], 5);
  using V = std::vector<float>;
  EXPECT_EQ(V(batch.bootstrap.begin(), batch.bootstrap.end()), (V{1, 1, 1}));
  EXPECT_EQ(V(batch.ends.begin(), batch.ends.end()), (V{0, 1, 0}));
  EXPECT_EQ(V(batch.continues.begin(), batch.continues.end()), (V{1, 0, 0}));
  EXPECT_EQ(batch.next_obs_vector[3], 3) << "what its value is bootstrapped from";
  EXPECT_EQ(core_->counters().dropped_rollouts, 0u);
  EXPECT_EQ(core_->used_records(), 5u);
}

TEST_F(RolloutCoreTest, AnEpisodeThatBreaksOffBetweenTwoRolloutsLeavesTheFirstAsItIs) {
  a_.PlayThree(0, 0);
  a_.Reset(0, 1, 7);
  core_->TakeChunk(a_.Chunk());
  ASSERT_EQ(core_->Ready(), 1);
  EXPECT_EQ(TakeReady().ends[2], 0);
  core_->Await({100, 1});
  for (uint32_t i = 1; i <= 3; ++i) a_.Step(0, 1, i, float(7 + i), {100, 1});
  core_->TakeChunk(a_.Chunk());
  ASSERT_EQ(core_->Ready(), 1);
  EXPECT_EQ(TakeReady().obs_vector[0], 7);
}

TEST_F(RolloutCoreTest, TheNextRolloutGoesOnWhereTheLastOneEnded) {
  a_.PlayThree(0, 0);
  core_->TakeChunk(a_.Chunk());
  TakeReady();
  core_->Await({100, 1});
  for (uint32_t i = 4; i <= 6; ++i) a_.Step(0, 0, i, float(i + 1), {100, 1});
  core_->TakeChunk(a_.Chunk());
  const BatchView batch = TakeReady();
  EXPECT_EQ(batch.obs_vector[0], 4);
  EXPECT_EQ(batch.weights_update[0], 1u);
}

TEST_F(RolloutCoreTest, AKilledActorsPartialRolloutIsDiscardedAndCounted) {
  a_.Reset(0, 0, 1);
  a_.Step(0, 0, 1, 2);
  a_.Step(0, 0, 2, 3);
  core_->TakeChunk(a_.Chunk());
  ActorScript successor(run_.spec, 0, 12);
  successor.PlayThree(0, 1);
  core_->TakeChunk(successor.Chunk());
  ASSERT_EQ(core_->Ready(), 1);
  EXPECT_EQ(TakeReady().reward.size(), 3u);
  EXPECT_EQ(Counters(0, 10).discarded, 3u);
  EXPECT_EQ(Counters(0, 12).discarded, 0u);
  EXPECT_EQ(core_->stored_steps(), 5u) << "they were played";
  EXPECT_EQ(core_->counters().dropped_rollouts, 1u);
}

TEST_F(RolloutCoreTest, RolloutsOfAnotherVersionAreDropped) {
  a_.PlayThree(0, 0, {99, 7});
  core_->TakeChunk(a_.Chunk());
  EXPECT_EQ(core_->Ready(), 0) << "of a learner that is gone";
  core_->Await({100, 1});
  b_.PlayThree(1, 0, {100, 0});
  core_->TakeChunk(b_.Chunk());
  EXPECT_EQ(core_->Ready(), 0) << "too late for its update";
  EXPECT_EQ(Counters(1, 11).discarded, 4u);
  EXPECT_EQ(core_->used_records(), 0u);
}

// Earlier both sides waited for ever if writing a checkpoint took longer than playing a rollout.
TEST_F(RolloutCoreTest, RolloutsByWeightsThatAreOutAreKeptUntilTheirUpdateIsAwaited) {
  a_.PlayThree(0, 0);
  core_->TakeChunk(a_.Chunk());
  TakeReady();
  for (uint32_t i = 4; i <= 6; ++i) a_.Step(0, 0, i, float(i + 1), {100, 1});
  core_->TakeChunk(a_.Chunk());
  core_->Await({100, 1});
  ASSERT_EQ(core_->Ready(), 1);
  EXPECT_EQ(TakeReady().weights_update[0], 1u);
  EXPECT_EQ(core_->counters().dropped_rollouts, 0u);
}

TEST_F(RolloutCoreTest, OneVersionAheadAnOlderRolloutServesOneUpdateMore) {
  run_.config.ppo.versions_ahead = 1;
  Restart(100);
  a_.PlayThree(0, 0);
  for (uint32_t i = 4; i <= 6; ++i) a_.Step(0, 0, i, float(i + 1));
  core_->TakeChunk(a_.Chunk());
  EXPECT_EQ(TakeReady().obs_vector[0], 1);
  core_->Await({100, 1});
  ASSERT_EQ(core_->Ready(), 1);
  EXPECT_EQ(TakeReady().obs_vector[0], 4);
  b_.PlayThree(1, 0);
  core_->TakeChunk(b_.Chunk());
  EXPECT_EQ(core_->Ready(), 1);
  core_->Await({100, 2});
  EXPECT_EQ(core_->Ready(), 0);
}

TEST_F(RolloutCoreTest, AStepWithoutItsPredecessorIsOfNoUse) {
  a_.Step(0, 3, 8, 2);  // the learner was restarted: it does not know the episode
  a_.Step(0, 3, 9, 2);
  EXPECT_EQ(core_->TakeChunk(a_.Chunk()).after_gap, 2u);
  EXPECT_EQ(core_->stored_steps(), 0u);
  a_.PlayThree(0, 4);
  EXPECT_EQ(core_->TakeChunk(a_.Chunk()).stored, 4u);
  EXPECT_EQ(core_->Ready(), 1);
}

TEST_F(RolloutCoreTest, ARestartedLearnerCountsWhatItsPredecessorHadNotUsedAsDiscarded) {
  a_.PlayThree(0, 0);
  core_->TakeChunk(a_.Chunk());
  TakeReady();
  b_.PlayThree(1, 0);
  core_->TakeChunk(b_.Chunk());
  const RunAccount before = core_->Account();
  Restart(200, before);
  EXPECT_EQ(core_->Ready(), 0);
  EXPECT_EQ(core_->used_records(), 4u);
  EXPECT_EQ(core_->stored_steps(), 6u);
  EXPECT_EQ(Counters(1, 11).discarded, 4u);
  EXPECT_EQ(Counters(0, 10).discarded, 0u);
}

TEST_F(RolloutCoreTest, MoreActorsAreWaitedForFromTheNextUpdateFewerAtOnce) {
  core_->SetActors(3);
  EXPECT_EQ(core_->Expected(), 2);
  core_->Await({100, 1});
  EXPECT_EQ(core_->Expected(), 3);
  core_->SetActors(1);
  EXPECT_EQ(core_->Expected(), 1);
}

TEST_F(RolloutCoreTest, UpdatesStopWaitingForAnEnvironmentThatSendsNothingUntilItSendsAgain) {
  a_.Reset(0, 0, 1);
  for (uint64_t update = 0; update < 3; ++update) {
    EXPECT_EQ(core_->Expected(), 2) << update;
    for (uint32_t i = 1; i <= 3; ++i) {
      a_.Step(0, 0, uint32_t(3 * update) + i, 1, {100, update});
    }
    core_->TakeChunk(a_.Chunk());
    ASSERT_EQ(core_->Ready(), 1);
    EXPECT_EQ(TakeReady().reward.size(), 3u);
    core_->Await({100, update + 1});
  }
  EXPECT_EQ(core_->Expected(), 1);
  EXPECT_EQ(core_->Absent(), 1);
  b_.Reset(1, 0, 1);
  core_->TakeChunk(b_.Chunk());
  EXPECT_EQ(core_->Expected(), 2) << "it is there again, however slow it is";
  EXPECT_EQ(core_->Absent(), 0);
}

TEST_F(RolloutCoreTest, EnvironmentsThatTheActorDoesNotHostAreRefused) {
  a_.PlayThree(1, 0);
  EXPECT_EQ(core_->TakeChunk(a_.Chunk()).after_gap, 4u);
}

TEST_F(RolloutCoreTest, GrantsCreditForWhatWasDealtWith) {
  a_.PlayThree(0, 0);
  core_->TakeChunk(a_.Chunk());
  const auto credits = core_->TakeCredits(/*changed_only=*/true);
  ASSERT_EQ(credits.size(), 1u);
  EXPECT_EQ(credits[0].stored, 4u);
  EXPECT_GT(credits[0].allowed, 4u);
  EXPECT_EQ(credits[0].replay_session, 100u);
}

}  // namespace
}  // namespace shoal::learner
