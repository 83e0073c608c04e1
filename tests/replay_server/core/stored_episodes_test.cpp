// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/stored_episodes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "tests/replay_server/record_script.h"
#include "tests/support/temporary_folder.h"

namespace shoal::replay {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class StoredEpisodesTest : public testing::Test {
 protected:
  // A step or, with index 0, a reset of episode 0 of `env`.
  uint64_t Append(uint32_t env, uint32_t index, uint64_t prev, uint8_t flags = 0) {
    const auto record = MakeRecord(spec_, 0, env, 0, index, ++sequence_, flags);
    return ring_.Append(0, 1, prev, record.data());
  }

  const ObservationSpec spec_ = TinySpec(1);
  TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "replay.ring";
  Ring ring_{spec_, {.file = file_, .capacity = 8, .run = "tiny"}};
  uint64_t sequence_ = 0;
};

TEST_F(StoredEpisodesTest, ThoseWithResetAndEndAreWholeInTheOrderOfTheirEnds) {
  Append(0, 0, 0);               // 1
  Append(1, 0, 0);               // 2
  Append(1, 1, 2, kTerminated);  // 3
  Append(0, 1, 1);               // 4
  Append(0, 2, 4, kTruncated);   // 5
  const StoredEpisodes episodes = FindEpisodes(ring_);
  EXPECT_THAT(episodes.whole, ElementsAre(ElementsAre(2, 3), ElementsAre(1, 4, 5)));
  EXPECT_EQ(episodes.overwritten, 0u);
  EXPECT_EQ(episodes.unended, 0u);
}

TEST_F(StoredEpisodesTest, OneThatGoesOnIsCounted) {
  Append(0, 0, 0);
  Append(0, 1, 1);
  Append(1, 0, 0);
  const StoredEpisodes episodes = FindEpisodes(ring_);
  EXPECT_THAT(episodes.whole, IsEmpty());
  EXPECT_EQ(episodes.unended, 2u);
}

TEST_F(StoredEpisodesTest, OneWhoseBeginningIsOverwrittenIsCountedOnce) {
  Append(0, 0, 0);                                           // 1
  for (uint32_t k = 1; k < 6; ++k) Append(0, k, sequence_);  // 2 .. 6
  Append(0, 6, 6, kTerminated);                              // 7
  Append(1, 0, 0);                                           // 8
  Append(1, 1, 8, kTerminated);                              // 9 over 1
  const StoredEpisodes episodes = FindEpisodes(ring_);
  EXPECT_THAT(episodes.whole, ElementsAre(ElementsAre(8, 9)));
  EXPECT_EQ(episodes.overwritten, 1u);
  EXPECT_EQ(episodes.unended, 0u);
}

TEST_F(StoredEpisodesTest, ACopyHoldsTheRecordsByteForByte) {
  Append(0, 0, 0);
  Append(0, 1, 1, kTerminated);
  const auto copy = CopyEpisode(ring_, {1, 2});
  ASSERT_TRUE(copy);
  const auto bytes = static_cast<size_t>(ring_.layout().record_bytes());
  ASSERT_EQ(copy->size(), 2 * bytes);
  EXPECT_EQ(std::memcmp(copy->data() + bytes, ring_.Record(2), bytes), 0);
}

TEST_F(StoredEpisodesTest, ThereIsNoCopyOfAnEpisodeThatAServerHasOverwrittenMeanwhile) {
  Append(0, 0, 0);
  Append(0, 1, 1, kTerminated);
  const Ring snapshot = Ring::OpenSnapshot(spec_, file_);
  const StoredEpisodes episodes = FindEpisodes(snapshot);
  ASSERT_THAT(episodes.whole, ElementsAre(ElementsAre(1, 2)));
  for (uint32_t k = 0; k < 7; ++k) Append(k + 1, 0, 0);  // the last of them over 1
  EXPECT_FALSE(CopyEpisode(snapshot, episodes.whole[0]));
}

}  // namespace
}  // namespace shoal::replay
