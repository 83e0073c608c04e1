// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/replay_core.h"

#include <gmock/gmock.h>

#include "common/base/error.h"
#include "tests/replay_server/core/replay_core_fixture.h"

namespace shoal::replay {
namespace {

using testing::HasSubstr;

TEST_F(ReplayCoreTest, ARepeatedRequestGetsTheSameBytesAndAnotherOneOthers) {
  Start();
  Store(&actor_, 1, 40);
  Ask(1);
  const auto first = Answer();
  ASSERT_FALSE(first.empty());
  Ask(2);
  EXPECT_NE(Answer(), first);
  Ask(1);
  EXPECT_EQ(Answer(), first);
  EXPECT_EQ(core_->counters().repeated_batches, 1u);
  EXPECT_EQ(core_->counters().batches, 2u);
}

TEST_F(ReplayCoreTest, WhoHasKeptABatchAnswersARepeatedRequestWithIt) {
  Start();
  Store(&actor_, 1, 40);
  EXPECT_FALSE(core_->NextRepeated());
  Ask(1);
  EXPECT_FALSE(core_->NextRepeated()) << "it was never answered";
  ASSERT_FALSE(Answer().empty());
  Ask(1);
  const auto again = core_->NextRepeated();
  ASSERT_TRUE(again);
  EXPECT_EQ(again->request, 1u);
  core_->AnsweredAgain();
  EXPECT_TRUE(Answer().empty()) << "nothing waits any more";
  EXPECT_EQ(core_->counters().batches, 1u);
  EXPECT_EQ(core_->counters().repeated_batches, 1u);
}

TEST_F(ReplayCoreTest, ASequenceIsWholeUnlessTheTaskEnds) {
  run_.config.learner.algorithm = "mrq";
  run_.config.mrq.horizon = 5;
  run_.config.replay.n_step = 1;
  Start();
  Store(&actor_, 1, 60);
  int ended = 0;
  for (uint64_t request = 1; request <= 50; ++request) {
    Ask(request);
    const AlignedBytes memory(core_->batch_schema().total_bytes());
    ASSERT_TRUE(core_->TryAnswer(memory.data()));
    const BatchView view = core_->batch_schema().View(memory.data());
    ASSERT_EQ(view.steps.size(), 5u);
    for (size_t b = 0; b < view.rows(); ++b) {
      bool goes_on = true;
      for (const StepView& step : view.steps) {
        ASSERT_EQ(step.present[b], goes_on ? 1 : 0);
        goes_on = goes_on && step.terminated[b] == 0;
      }
      ended += goes_on ? 0 : 1;
    }
  }
  EXPECT_GT(ended, 0);
  EXPECT_LT(ended, 50 * run_.config.learner.batch);
}

TEST_F(ReplayCoreTest, WordsOfAFormerLearnerAreCounted) {
  Start();
  Ask(1, 0, /*session=*/8);
  Ask(5, 0, /*session=*/7);
  EXPECT_EQ(core_->counters().stale_requests, 1u);
  EXPECT_EQ(core_->requests().size(), 1u);
}

TEST_F(ReplayCoreTest, AnswersDependOnSeedAndRequestOnlyNotOnTheLearnersSession) {
  Start();
  Store(&actor_, 1, 40);
  Ask(5);
  const auto first = Answer();
  Ask(5, 0, /*session=*/9);
  EXPECT_EQ(Answer(), first);
  run_.config.seed += 1;
  Start();
  Store(&actor_, 1, 40);
  Ask(5);
  EXPECT_NE(Answer(), first);
}

TEST_F(ReplayCoreTest, ABatchWaitsForItsStepsAndTellsWhatWasStored) {
  run_.config.lockstep = true;
  run_.config.replay.min_size = 20;
  Start();
  Store(&actor_, 1, 3);
  ASSERT_EQ(Ask(1, /*after_steps=*/10), RequestFate::kQueued);
  EXPECT_TRUE(Answer().empty());
  EXPECT_TRUE(core_->SamplesBlocked());
  for (uint64_t next = 4; core_->ring().stored_steps() < 10; ++next) {
    EXPECT_TRUE(Answer().empty());
    Store(&actor_, next, 1);
  }
  EXPECT_FALSE(core_->SamplesBlocked());
  EXPECT_FALSE(Answer().empty()) << "lockstep has its own rule for the beginning";
  EXPECT_EQ(drawn_->stored_steps, 10u);
  EXPECT_EQ(drawn_->stored_records, core_->ring().last_id());
}

TEST_F(ReplayCoreTest, TheLimiterWithholdsCreditAndBatchesAndOneOfThemAlwaysMoves) {
  run_.config.replay.samples_per_insert = Schedule::Constant(2);
  run_.config.replay.min_size = 8;
  Start();
  uint64_t next = 1, request = 1;
  // The actor sends as far as it is allowed to; no batch is asked for.
  const auto send_all = [&] {
    for (;;) {
      const auto credits = core_->TakeCredits(false);
      if (!credits.empty() && credits[0].allowed < next) return;
      Store(&actor_, next++, 1);
    }
  };
  send_all();
  EXPECT_TRUE(core_->InsertsBlocked());
  EXPECT_GT(core_->limiter().cursor(), 0);
  uint64_t batches = 0;
  for (; Ask(request) == RequestFate::kQueued && !Answer().empty(); ++request) {
    ASSERT_LT(++batches, 1000u);
  }
  EXPECT_TRUE(core_->SamplesBlocked());
  EXPECT_FALSE(core_->InsertsBlocked());
  EXPECT_GT(batches, 0u);
  const uint64_t sent_before = next;
  send_all();
  EXPECT_GT(next, sent_before);
  EXPECT_FALSE(Answer().empty()) << "the request that waited";
}

// Two actors of which one is four times as fast send whatever they are allowed to.
TEST_F(ReplayCoreTest, TheBudgetIsReachedAndOverspentByLessThanOneChunkPerActor) {
  run_.config.env_steps = 300;
  run_.config.replay.capacity = 1000;
  run_.config.envs_per_actor = 1;
  Start();
  RecordScript slow(run_.spec, 1, 11);
  RecordScript* const scripts[] = {&actor_, &slow};
  uint64_t made[] = {0, 0}, allowed[] = {1, 1};
  const auto turn = [&](size_t i) {
    if (made[i] >= allowed[i]) return;
    ++made[i];
    ASSERT_EQ(Store(scripts[i], made[i], 1).stored, 1u);
    for (const Credit& credit : core_->TakeCredits(true)) allowed[credit.actor] = credit.allowed;
  };
  for (int turns = 0; turns < 2000; ++turns) turn(turns % 5 == 0 ? 1 : 0);
  const auto chunk = static_cast<uint64_t>(run_.config.transport.chunk_records);
  EXPECT_GE(core_->ring().stored_steps(), 300u);
  EXPECT_LE(core_->ring().stored_steps(), 300u + 2 * chunk);
  EXPECT_FALSE(core_->InsertsBlocked()) << "the limiter has no part in it";

  const uint64_t before = made[0];
  core_->SetBudget(400);
  for (const Credit& credit : core_->TakeCredits(true)) allowed[credit.actor] = credit.allowed;
  for (int turns = 0; turns < 500; ++turns) turn(0);
  EXPECT_GT(made[0], before) << "a raised budget lets them go on";
  EXPECT_GE(core_->ring().stored_steps(), 400u);

  core_->SetDraining(true);
  EXPECT_GT(core_->TakeCredits(true).at(0).allowed, made[0]) << "what was made may be sent";
}

TEST_F(ReplayCoreTest, AResentRequestIsNotChargedToTheLimiter) {
  run_.config.replay.samples_per_insert = Schedule::Constant(2);
  Start();
  Store(&actor_, 1, 8);
  Ask(1);
  ASSERT_FALSE(Answer().empty());
  const double cursor = core_->limiter().cursor();
  for (int i = 0; i < 100; ++i) {
    Ask(1);
    ASSERT_FALSE(Answer().empty());
  }
  EXPECT_EQ(core_->limiter().cursor(), cursor);
  for (uint64_t request = 2; !core_->SamplesBlocked(); ++request) {
    ASSERT_LT(request, 1000u);
    Ask(request);
    Answer();
  }
  Ask(1);
  EXPECT_FALSE(Answer().empty()) << "nor held back by it";
}

TEST_F(ReplayCoreTest, DrainingLetsTheLearnerFinishAndTheActorsFlush) {
  run_.config.replay.samples_per_insert = Schedule::Constant(0.5);
  Start();
  Store(&actor_, 1, 12);
  for (uint64_t request = 1; request < 100; ++request) {
    Ask(request);
    if (Answer().empty()) break;
  }
  ASSERT_TRUE(core_->SamplesBlocked());
  core_->SetDraining(true);
  EXPECT_FALSE(Answer().empty());
}

TEST_F(ReplayCoreTest, ARestartedServerKnowsItsActorsAndRebuildsTheCursor) {
  run_.config.replay.storage = "file";
  run_.config.replay.samples_per_insert = Schedule::Constant(2);
  Start();
  Store(&actor_, 1, 30);
  ASSERT_NE(core_->limiter().cursor(), 0);
  const uint64_t sampleable = core_->index().sampleable();
  core_.reset();
  Start();
  EXPECT_EQ(core_->limiter().cursor(), 0);
  EXPECT_EQ(core_->index().sampleable(), sampleable);
  const auto credits = core_->TakeCredits(true);
  ASSERT_EQ(credits.size(), 1u);
  EXPECT_EQ(credits[0].replay_session, 2u);
  EXPECT_EQ(credits[0].stored, 30u);
  EXPECT_EQ(credits[0].allowed, 38u);
  EXPECT_EQ(Store(&actor_, 29, 4).stored, 2u) << "episodes go on across the restart";
}

// The env steps of a run go on over restarts, also those that the ring has forgotten.
TEST_F(ReplayCoreTest, ARestartedServerGoesOnWithAScheduleWhereTheRunStands) {
  run_.config.replay.storage = "file";
  run_.config.replay.samples_per_insert = Schedule{8, 1, 200};
  Start();
  Store(&actor_, 1, 60);
  Store(&actor_, 61, 60);
  const uint64_t stored = core_->ring().stored_steps();
  core_.reset();
  Start();
  const uint64_t became_before = core_->index().became_sampleable();
  Store(&actor_, 121, 8);
  const uint64_t became = core_->index().became_sampleable() - became_before;
  ASSERT_EQ(became, core_->ring().stored_steps() - stored) << "each as it is stored";
  ASSERT_GT(became, 2u);
  EXPECT_DOUBLE_EQ(core_->limiter().cursor(),
                   run_.config.replay.samples_per_insert.Integral(stored, stored + became));
}

TEST_F(ReplayCoreTest, AnActorOfAnotherSpecIsToldOurs) {
  Start();
  TransitionChunk chunk = actor_.Chunk(1, 2);
  chunk.spec_hash ^= 1;
  EXPECT_EQ(core_->TakeChunk(chunk).fate, ChunkFate::kWrongSpec);
  const Credit refusal = core_->Refusal(chunk);
  EXPECT_EQ(refusal.spec_hash, run_.spec.Hash());
  EXPECT_EQ(refusal.session, 10u);
  EXPECT_EQ(refusal.allowed, 0u);
  EXPECT_EQ(core_->counters().intake.wrong_spec_chunks, 1u);
}

TEST_F(ReplayCoreTest, AProcessWhoseNumberHasANewerSessionIsToldOfIt) {
  Start();
  RecordScript newer(TinySpec(2), 0, 12);
  Store(&newer, 1, 2);
  const TransitionChunk late = actor_.Chunk(1, 2);
  EXPECT_EQ(core_->TakeChunk(late).fate, ChunkFate::kSuperseded);
  EXPECT_EQ(core_->Refusal(late).superseded_by, 12u);
  EXPECT_EQ(core_->Refusal(newer.Chunk(3, 1)).superseded_by, 0u);
}

TEST_F(ReplayCoreTest, AServerWithoutItsPredecessorsRingTakesItsActorsOver) {
  const FormerServer former{
      .stored_steps = 40, .sessions = {{.actor = 0, .session = 10, .highest = 44, .rejected = 1}}};
  core_.emplace(run_, folder_.path(), 2, former);
  EXPECT_TRUE(core_->ring_replaced());
  EXPECT_EQ(core_->ring().stored_steps(), 40u) << "env steps go on counting";
  EXPECT_EQ(core_->sessions().at(0).lost, 43u);
  const auto credits = core_->TakeCredits(true);
  ASSERT_EQ(credits.size(), 1u) << "the actor, which has spent its credit, may go on at once";
  EXPECT_EQ(credits[0].stored, 44u);
  EXPECT_GT(credits[0].allowed, 44u);
  core_.emplace(run_, folder_.path(), 3, FormerServer{});
  EXPECT_FALSE(core_->ring_replaced()) << "there was no server before";
}

TEST_F(ReplayCoreTest, ARingThatNeverHoldsEnoughSamplesIsRefusedBeforehand) {
  run_.config.replay.n_step = 20;
  run_.config.envs_per_actor = 4;
  run_.config.replay.min_size = 32;
  run_.config.replay.capacity = 32 + 4 * (20 + run_.spec.stack);
  EXPECT_NO_THROW(CheckSampling(run_));
  --run_.config.replay.capacity;
  try {
    CheckSampling(run_);
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("replay.capacity"));
    EXPECT_THAT(e.what(), HasSubstr("replay.n_step = 20"));
    EXPECT_EQ(e.exit_code(), 2);
  }
}

TEST_F(ReplayCoreTest, RefusesABandInWhichBothCouldWait) {
  run_.config.replay.samples_per_insert = Schedule::Constant(2);
  run_.config.replay.band = 10;
  try {
    Start();
    FAIL();
  } catch (const Error& e) {
    // 2 * (2 * 8 records of window + 3 credits * 8)
    EXPECT_THAT(e.what(), HasSubstr("replay.band 10 is too small"));
    EXPECT_THAT(e.what(), HasSubstr("at least 80"));
    EXPECT_EQ(e.exit_code(), 2);
  }
  EXPECT_THROW(CheckSampling(run_), Error) << "before anything is started";
}

}  // namespace
}  // namespace shoal::replay
