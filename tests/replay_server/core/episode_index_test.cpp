// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/episode_index.h"

#include <gtest/gtest.h>

#include "tests/replay_server/record_script.h"

namespace shoal::replay {
namespace {

// One environment; stores records by index, as a good actor would.
class EpisodeIndexTest : public testing::Test {
 protected:
  void Open(int stack, uint64_t capacity, int n_step = 1, bool whole_episodes = false) {
    spec_ = TinySpec(stack);
    ring_.emplace(spec_, RingOptions{.file = {}, .capacity = capacity, .run = ""});
    options_ = {.stack = stack, .n_step = n_step, .whole_episodes = whole_episodes};
    index_.emplace(*ring_, options_);
  }
  uint64_t Store(uint32_t env, uint32_t episode, uint32_t index, uint8_t flags = 0) {
    const auto record = MakeRecord(spec_, 0, env, episode, index, 1, flags);
    const auto prev = index_->Predecessor(0, 1, RecordLayout::Header(record.data()));
    if (!prev) return 0;
    const uint64_t id = ring_->Append(0, 1, *prev, record.data());
    index_->Added(id);
    return id;
  }

  ObservationSpec spec_;
  IndexOptions options_;
  std::optional<Ring> ring_;
  std::optional<EpisodeIndex> index_;
};

TEST_F(EpisodeIndexTest, EveryStepAfterAResetIsSampleableWhateverTheStack) {
  Open(/*stack=*/3, 100);
  for (uint32_t i = 0; i < 5; ++i) Store(0, 0, i);
  EXPECT_FALSE(index_->Sampleable(1)) << "a reset is no transition";
  EXPECT_EQ(index_->sampleable(), 4u);
}

TEST_F(EpisodeIndexTest, OverwritingAFrameTakesTheStepsThatNeedIt) {
  Open(/*stack=*/2, 6);
  for (uint32_t i = 0; i < 6; ++i) Store(0, 0, i);  // ids 1..6, index = id - 1
  EXPECT_EQ(index_->sampleable(), 5u);
  // Record 7 overwrites the reset, which the stacks of steps 2 and 3 reach.
  Store(0, 0, 6);
  EXPECT_FALSE(index_->Sampleable(2));
  EXPECT_FALSE(index_->Sampleable(3));
  EXPECT_TRUE(index_->Sampleable(4));
  EXPECT_EQ(index_->sampleable(), 4u);
  Store(0, 0, 7);
  EXPECT_FALSE(index_->Sampleable(4));
  EXPECT_EQ(index_->sampleable(), 4u);
}

TEST_F(EpisodeIndexTest, AStepWhosePredecessorIsOverwrittenIsNotSampleable) {
  Open(/*stack=*/1, 4);
  Store(0, 0, 0);
  Store(0, 0, 1);
  for (uint32_t i = 0; i < 4; ++i) Store(1, 0, i);
  const uint64_t late = Store(0, 0, 2);
  ASSERT_NE(late, 0u);
  EXPECT_FALSE(index_->Sampleable(late));
  const uint64_t next = Store(0, 0, 3);
  EXPECT_TRUE(index_->Sampleable(next));
}

TEST_F(EpisodeIndexTest, NStepsNeedAsManyOfOneEpisode) {
  Open(/*stack=*/2, 8, /*n_step=*/3);
  for (uint32_t i = 0; i < 6; ++i) Store(0, 0, i);  // ids 1..6, index = id - 1
  EXPECT_TRUE(index_->Sampleable(2)) << "from the reset on";
  EXPECT_TRUE(index_->Sampleable(4));
  EXPECT_FALSE(index_->Sampleable(5)) << "only one step follows";
  EXPECT_EQ(index_->sampleable(), 3u);
  for (uint32_t i = 6; i < 9; ++i) Store(0, 0, i);
  // Record 9 overwrote the reset: it was the oldest frame of the samples that begin with 2 and 3.
  EXPECT_FALSE(index_->Sampleable(2));
  EXPECT_FALSE(index_->Sampleable(3));
  EXPECT_TRUE(index_->Sampleable(4));
  EXPECT_EQ(index_->sampleable(), 4u);
}

TEST_F(EpisodeIndexTest, ATerminationMakesItsLastStepsSampleableATimeLimitDoesNot) {
  for (const uint8_t flags : {uint8_t{kTerminated}, uint8_t{kTruncated}}) {
    Open(/*stack=*/1, 100, /*n_step=*/3);
    for (uint32_t i = 0; i < 4; ++i) Store(0, 0, i);  // steps 2, 3, 4
    EXPECT_EQ(index_->sampleable(), 1u);
    Store(0, 0, 4, flags);
    const bool terminated = (flags & kTerminated) != 0;
    EXPECT_TRUE(index_->Sampleable(3)) << "three steps";
    EXPECT_EQ(index_->Sampleable(4), terminated) << "two";
    EXPECT_EQ(index_->Sampleable(5), terminated) << "one";
    EXPECT_EQ(index_->sampleable(), terminated ? 4u : 2u);
    EXPECT_EQ(index_->unsampleable(), terminated ? 0u : 2u) << "never of a time limit's last steps";
  }
}

TEST_F(EpisodeIndexTest, AnEpisodeShorterThanNStepsIsSampledWhenItTerminates) {
  Open(/*stack=*/2, 100, /*n_step=*/5);
  Store(0, 0, 0);
  Store(0, 0, 1);
  Store(0, 0, 2, kTerminated);
  EXPECT_TRUE(index_->Sampleable(2));
  EXPECT_TRUE(index_->Sampleable(3));
  EXPECT_FALSE(index_->Sampleable(1)) << "a reset is no transition";
}

TEST_F(EpisodeIndexTest, WholeEpisodesAreSampleableOnceTheyEnd) {
  Open(/*stack=*/2, 100, /*n_step=*/1, /*whole_episodes=*/true);
  for (uint32_t i = 0; i < 4; ++i) Store(0, 0, i);  // steps 2, 3, 4
  EXPECT_EQ(index_->sampleable(), 0u);
  EXPECT_EQ(index_->unsampleable(), 3u) << "they wait";
  index_.emplace(*ring_, options_);
  EXPECT_EQ(index_->unsampleable(), 0u) << "of steps before a restart nothing is known";
  Store(0, 0, 4, kTruncated);
  EXPECT_EQ(index_->unsampleable(), 0u);
  EXPECT_EQ(index_->sampleable(), 4u) << "truncated";
  for (uint32_t i = 0; i < 3; ++i) Store(0, 1, i);
  EXPECT_EQ(index_->sampleable(), 4u);
  index_->Close(0, 1, 0);
  EXPECT_EQ(index_->sampleable(), 6u) << "closed by a gap";
  Store(0, 2, 0);
  Store(0, 2, 1);
  Store(0, 3, 0);
  EXPECT_EQ(index_->sampleable(), 7u) << "a reset in the middle";
}

TEST_F(EpisodeIndexTest, OfAnEpisodeThatIsPartlyGoneTheRestIsSampleable) {
  Open(/*stack=*/1, 4, /*n_step=*/1, /*whole_episodes=*/true);
  for (uint32_t i = 0; i < 6; ++i) Store(0, 0, i, i == 5 ? uint8_t{kTerminated} : uint8_t{0});
  EXPECT_EQ(index_->sampleable(), 3u) << "steps 4, 5, 6; step 3 has lost its predecessor";
  EXPECT_FALSE(index_->Sampleable(3));
}

TEST_F(EpisodeIndexTest, KnowsWhatFollows) {
  Open(1, 4);
  Store(0, 0, 0);
  Store(1, 0, 0);
  Store(0, 0, 1);
  EXPECT_EQ(index_->Next(1), 3u);
  EXPECT_EQ(index_->Next(2), 0u);
  EXPECT_EQ(index_->Next(3), 0u);
  Store(0, 0, 2);
  Store(0, 0, 3);  // record 5, in the slot of record 1
  EXPECT_EQ(index_->Next(5), 0u) << "not what followed record 1";
  EXPECT_EQ(index_->Next(4), 5u);
}

TEST_F(EpisodeIndexTest, OnlyTheNextIndexOfTheOpenEpisodeFollows) {
  Open(1, 100);
  Store(0, 4, 0);
  EXPECT_EQ(Store(0, 4, 2), 0u) << "skips one";
  EXPECT_EQ(Store(0, 5, 1), 0u) << "of another episode";
  EXPECT_EQ(Store(1, 4, 1), 0u) << "of another environment";
  EXPECT_NE(Store(0, 4, 1, kTerminated), 0u);
  EXPECT_EQ(Store(0, 4, 2), 0u) << "after the end";
}

TEST_F(EpisodeIndexTest, CountsEpisodesThatWereCutShort) {
  Open(1, 100);
  Store(0, 0, 0);
  Store(0, 0, 1, kTruncated);
  Store(0, 1, 0);
  EXPECT_EQ(index_->cut_episodes(), 0u);
  Store(0, 2, 0);
  EXPECT_EQ(index_->cut_episodes(), 1u) << "a reset in the middle";
  index_->Close(0, 1, 0);
  index_->Close(0, 1, 0);
  EXPECT_EQ(index_->cut_episodes(), 2u) << "closed once";
  EXPECT_EQ(Store(0, 2, 1), 0u);
}

TEST_F(EpisodeIndexTest, ARebuiltIndexEqualsTheOneThatGrew) {
  Open(/*stack=*/2, 23, /*n_step=*/2);
  RecordScript script(spec_, 0, 1, 3);
  for (uint64_t sequence = 1; sequence <= 100; ++sequence) {
    const RecordHeader& header = RecordLayout::Header(script.At(sequence).data());
    index_->Added(
        ring_->Append(0, 1, *index_->Predecessor(0, 1, header), script.At(sequence).data()));
    const EpisodeIndex rebuilt(*ring_, options_);
    ASSERT_EQ(rebuilt.sampleable(), index_->sampleable());
    for (uint64_t id = 1; id <= sequence; ++id) {
      ASSERT_EQ(rebuilt.Sampleable(id), index_->Sampleable(id));
      if (ring_->Holds(id)) {
        ASSERT_EQ(rebuilt.Next(id), index_->Next(id));
      }
    }
  }
}

}  // namespace
}  // namespace shoal::replay
