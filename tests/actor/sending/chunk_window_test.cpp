// SPDX-License-Identifier: Apache-2.0
#include "actor/sending/chunk_window.h"

#include <gtest/gtest.h>

#include <deque>
#include <map>

#include "common/base/random.h"

namespace shoal::actor {
namespace {

constexpr uint32_t kActor = 3;
constexpr uint64_t kSession = 77;
constexpr int kRecordBytes = 16;

ChunkWindow MakeWindow(int chunk_records = 4, int chunks = 3) {
  return ChunkWindow({.spec_hash = 9,
                      .actor = kActor,
                      .session = kSession,
                      .record_bytes = kRecordBytes,
                      .chunk_records = chunk_records,
                      .chunks = chunks,
                      .first_records = static_cast<uint64_t>(chunks - 1) * chunk_records});
}

Credit MakeCredit(uint64_t replay, uint64_t stored, uint64_t allowed) {
  Credit credit;
  credit.replay_session = replay;
  credit.actor = kActor;
  credit.session = kSession;
  credit.stored = stored;
  credit.allowed = allowed;
  return credit;
}

// Writes records first..last, each filled with its sequence.
void Fill(ChunkWindow& window, uint64_t first, uint64_t last) {
  for (uint64_t sequence = first; sequence <= last; ++sequence) {
    std::fill_n(window.BeginRecord(), kRecordBytes, static_cast<uint8_t>(sequence));
    window.EndRecord(sequence);
  }
}

TEST(ChunkWindow, SendsClosedChunksInOrder) {
  ChunkWindow window = MakeWindow();
  EXPECT_FALSE(window.NextToSend());
  Fill(window, 1, 6);
  auto chunk = window.NextToSend();
  ASSERT_TRUE(chunk);
  EXPECT_EQ(chunk->actor, kActor);
  EXPECT_EQ(chunk->session, kSession);
  EXPECT_EQ(chunk->spec_hash, 9u);
  EXPECT_EQ(chunk->first_sequence, 1u);
  EXPECT_EQ(chunk->count, 4u);
  EXPECT_EQ(chunk->payload.size(), 4u * kRecordBytes);
  EXPECT_EQ(chunk->payload[3 * kRecordBytes], 4);
  window.MarkSent();
  EXPECT_FALSE(window.NextToSend()) << "the second chunk is still open";
  window.Flush();
  chunk = window.NextToSend();
  ASSERT_TRUE(chunk);
  EXPECT_EQ(chunk->first_sequence, 5u);
  EXPECT_EQ(chunk->count, 2u);
}

TEST(ChunkWindow, NothingLeavesTheAllowedWindow) {
  ChunkWindow window = MakeWindow(4, 3);
  Fill(window, 1, 12);
  EXPECT_EQ(window.Room(), 0u);
  window.MarkSent();
  window.MarkSent();
  EXPECT_FALSE(window.NextToSend()) << "two chunks are allowed before the first word";
  window.OnCredit(MakeCredit(1, 4, 11));
  EXPECT_FALSE(window.NextToSend()) << "the chunk ends at 12";
  window.OnCredit(MakeCredit(1, 4, 12));
  EXPECT_TRUE(window.NextToSend());
}

TEST(ChunkWindow, StoredChunksMakeRoom) {
  ChunkWindow window = MakeWindow(4, 3);
  Fill(window, 1, 12);
  EXPECT_EQ(window.Outstanding(), 12u);
  window.MarkSent();
  window.OnCredit(MakeCredit(1, 3, 20));
  EXPECT_EQ(window.Room(), 0u) << "a chunk is kept until all of it is stored";
  window.OnCredit(MakeCredit(1, 4, 20));
  EXPECT_EQ(window.Room(), 4u);
  EXPECT_EQ(window.Outstanding(), 8u);
}

TEST(ChunkWindow, NothingIsMadeThatIsNotAllowed) {
  ChunkWindow window = MakeWindow(4, 5);
  window.OnCredit(MakeCredit(1, 0, 6));
  EXPECT_EQ(window.Room(), 6u);
  Fill(window, 1, 4);
  EXPECT_EQ(window.Room(), 2u);
  window.OnCredit(MakeCredit(1, 0, 3));
  EXPECT_EQ(window.Room(), 0u) << "a later word may allow less";
  EXPECT_FALSE(window.NextToSend()) << "the chunk ends at 4";
  window.OnCredit(MakeCredit(1, 0, 4));
  EXPECT_TRUE(window.NextToSend());
}

TEST(ChunkWindow, BeginsWithWhatTheReplayLearnsOfItBy) {
  const ChunkWindow window({.record_bytes = kRecordBytes,
                            .chunk_records = 4,
                            .chunks = 5,
                            .first_records = 6,
                            .records_before = 100});
  EXPECT_EQ(window.Room(), 6u);
}

TEST(ChunkWindow, IgnoresOthersAndThePast) {
  ChunkWindow window = MakeWindow();
  Fill(window, 1, 4);
  window.MarkSent();
  Credit other = MakeCredit(5, 4, 100);
  other.session = kSession - 1;
  window.OnCredit(other);
  other = MakeCredit(5, 4, 100);
  other.actor = kActor + 1;
  window.OnCredit(other);
  EXPECT_EQ(window.stored(), 0u);
  window.OnCredit(MakeCredit(5, 2, 8));
  window.OnCredit(MakeCredit(4, 4, 100));
  EXPECT_EQ(window.stored(), 2u) << "a replay session that is gone has no say";
}

TEST(ChunkWindow, ANewReplayGetsAgainWhatIsNotStored) {
  ChunkWindow window = MakeWindow(4, 4);
  Fill(window, 1, 12);
  window.OnCredit(MakeCredit(1, 0, 12));
  for (int i = 0; i < 3; ++i) window.MarkSent();
  window.OnCredit(MakeCredit(1, 4, 12));
  EXPECT_FALSE(window.NextToSend());
  window.OnCredit(MakeCredit(2, 4, 12));
  window.MarkSent();  // where the keeping begins
  ASSERT_TRUE(window.NextToSend());
  EXPECT_EQ(window.NextToSend()->first_sequence, 5u);
  EXPECT_EQ(window.NextToSend()->count, 4u);
  window.MarkSent();
  EXPECT_EQ(window.resent_records(), 4u);
}

TEST(ChunkWindow, WhatIsSentAgainIsLedByWhereTheKeepingBegins) {
  ChunkWindow window = MakeWindow();
  Fill(window, 1, 4);
  window.MarkSent();
  window.Rewind();
  EXPECT_EQ(window.NextToSend()->count, 4u) << "nothing was ever reported stored";
  window.MarkSent();
  window.OnCredit(MakeCredit(1, 4, 12));
  Fill(window, 5, 10);
  window.MarkSent();  // 5..8; 9 and 10 are in the open chunk
  window.OnCredit(MakeCredit(2, 0, 8));
  auto position = window.NextToSend();
  ASSERT_TRUE(position);
  EXPECT_EQ(position->count, 0u);
  EXPECT_EQ(position->first_sequence, 5u);
  EXPECT_EQ(position->actor, kActor);
  EXPECT_EQ(position->session, kSession);
  EXPECT_EQ(position->spec_hash, 9u);
  EXPECT_TRUE(position->payload.empty());
  window.MarkSent();
  EXPECT_EQ(window.NextToSend()->first_sequence, 5u);
  EXPECT_EQ(window.NextToSend()->count, 4u);
  EXPECT_EQ(window.resent_records(), 4u) << "of the first rewind; the word itself is no record";
}

TEST(ChunkWindow, WithNothingKeptItSaysWhatComesNext) {
  ChunkWindow window = MakeWindow();
  Fill(window, 1, 4);
  window.MarkSent();
  window.OnCredit(MakeCredit(1, 4, 4));  // all stored, no credit: the replay dies here
  EXPECT_FALSE(window.NextToSend());
  window.Rewind();
  ASSERT_TRUE(window.NextToSend());
  EXPECT_EQ(window.NextToSend()->count, 0u);
  EXPECT_EQ(window.NextToSend()->first_sequence, 5u);
}

TEST(ChunkWindow, ANewReplayMayAllowLess) {
  ChunkWindow window = MakeWindow(4, 4);
  Fill(window, 1, 12);
  window.OnCredit(MakeCredit(1, 0, 12));
  window.OnCredit(MakeCredit(2, 0, 4));
  EXPECT_EQ(window.NextToSend()->first_sequence, 1u);
  window.MarkSent();
  EXPECT_FALSE(window.NextToSend());
}

// A lossy, restarting replay that keeps only stored records. After duplicates are dropped, all
// records arrive in order in spite of the losses.
TEST(ChunkWindow, EverythingIsStoredInTheEndDespiteLossAndRestarts) {
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    Random random(seed);
    ChunkWindow window = MakeWindow(3, 4);
    uint64_t made = 0, stored = 0, replay = 1;
    const uint64_t total = 200;
    for (int turn = 0; turn < 20'000 && stored < total; ++turn) {
      while (window.Room() > 0 && made < total && random.Below(4) > 0) {
        Fill(window, made + 1, made + 1);
        ++made;
      }
      if (random.Below(5) == 0) window.Flush();
      while (const auto chunk = window.NextToSend()) {
        const bool lost = random.Below(4) == 0;
        if (!lost && chunk->first_sequence <= stored + 1) {
          for (uint32_t i = 0; i < chunk->count; ++i) {
            const uint64_t sequence = chunk->first_sequence + i;
            ASSERT_EQ(chunk->payload[i * kRecordBytes], static_cast<uint8_t>(sequence));
            if (sequence == stored + 1) ++stored;
          }
        }
        window.MarkSent();
      }
      if (random.Below(20) == 0) ++replay;
      if (random.Below(3) > 0) window.OnCredit(MakeCredit(replay, stored, stored + 9));
      if (window.HasUnstoredSent() && random.Below(4) == 0) window.Rewind();
      if (made == total) window.Flush();
    }
    EXPECT_EQ(stored, total) << "seed " << seed;
  }
}

}  // namespace
}  // namespace shoal::actor
