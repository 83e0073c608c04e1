// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/intake.h"

#include <gtest/gtest.h>

#include <memory>

#include "tests/replay_server/record_script.h"

namespace shoal::replay {
namespace {

class IntakeTest : public testing::Test {
 protected:
  const SessionCounters& Counters(const RecordScript& script) {
    return sessions_.at(*sessions_.Find(script.actor(), script.session()));
  }

  // A chunk of hand-made records with sequences from `first`.
  TransitionChunk Chunk(uint64_t first, const std::vector<std::vector<uint8_t>>& records) {
    payload_.clear();
    for (const auto& r : records) payload_.insert(payload_.end(), r.begin(), r.end());
    return {.spec_hash = spec_.Hash(),
            .actor = 7,
            .count = static_cast<uint32_t>(records.size()),
            .session = 70,
            .first_sequence = first,
            .payload = payload_};
  }
  std::vector<uint8_t> Record(uint32_t episode, uint32_t index, uint64_t sequence,
                              uint8_t flags = 0) {
    return MakeRecord(spec_, 7, /*env=*/0, episode, index, sequence, flags);
  }

  const ObservationSpec spec_ = TinySpec(1);
  Ring ring_{spec_, {.file = {}, .capacity = 100, .run = "test"}};
  SessionTable sessions_{ring_.sessions()};
  EpisodeIndex index_{ring_, {}};
  Intake intake_{spec_.Hash(), &ring_, &sessions_, &index_};
  RecordScript a_{spec_, 0, 10}, b_{spec_, 1, 11};
  std::vector<uint8_t> payload_;
};

TEST_F(IntakeTest, StoresRecordsVerbatim) {
  ASSERT_EQ(intake_.Take(a_.Chunk(1, 5)).stored, 5u);
  const auto bytes = static_cast<size_t>(ring_.layout().record_bytes());
  for (uint64_t id = 1; id <= 5; ++id) {
    const uint8_t* stored = ring_.Record(id);
    EXPECT_EQ(std::vector<uint8_t>(stored, stored + bytes), a_.At(id));
    EXPECT_EQ(ring_.Slot(id).session, 10u);
  }
}

TEST_F(IntakeTest, DropsAndCountsDuplicates) {
  intake_.Take(a_.Chunk(1, 5));
  const ChunkResult result = intake_.Take(a_.Chunk(3, 5));
  EXPECT_EQ(result.duplicates, 3u);
  EXPECT_EQ(result.stored, 2u);
  EXPECT_EQ(intake_.Take(a_.Chunk(1, 7)).duplicates, 7u);
  EXPECT_EQ(Counters(a_).duplicates, 10u);
  EXPECT_EQ(Counters(a_).stored(), 7u);
  EXPECT_EQ(ring_.last_id(), 7u);
}

TEST_F(IntakeTest, KeepsTwoInterleavedActorsApart) {
  for (uint64_t k = 0; k < 20; ++k) {
    intake_.Take(a_.Chunk(1 + 2 * k, 2));
    intake_.Take(b_.Chunk(1 + 2 * k, 2));
  }
  EXPECT_EQ(Counters(a_).stored(), 40u);
  EXPECT_EQ(Counters(b_).stored(), 40u);
  for (uint64_t id = 1; id <= 80; ++id) {
    const uint64_t prev = ring_.Slot(id).prev;
    EXPECT_TRUE(prev == 0 || ring_.Slot(prev).actor == ring_.Slot(id).actor);
  }
}

TEST_F(IntakeTest, SetsAsideWhatIsAheadUntilTheMissingOnesCome) {
  intake_.Take(a_.Chunk(1, 4));
  EXPECT_EQ(intake_.Take(a_.Chunk(9, 4)).fate, ChunkFate::kAhead);
  EXPECT_EQ(Counters(a_).highest, 4u);
  EXPECT_EQ(intake_.Take(a_.Chunk(5, 4)).stored, 4u);
  EXPECT_EQ(intake_.Take(a_.Chunk(9, 4)).stored, 4u);
  EXPECT_EQ(Counters(a_).lost, 0u);
  EXPECT_EQ(Counters(a_).stored(), 12u);
}

// The message of an actor before a resend.
TransitionChunk Position(const RecordScript& script, const ObservationSpec& spec, uint64_t first) {
  return {.spec_hash = spec.Hash(),
          .actor = script.actor(),
          .session = script.session(),
          .first_sequence = first,
          .payload = {}};
}

TEST_F(IntakeTest, ASessionThatBeganWithAnEarlierServerGoesOnWhereTheActorsKeepingBegins) {
  EXPECT_EQ(intake_.Take(a_.Chunk(9, 4)).fate, ChunkFate::kAhead) << "it was sent before the word";
  const ChunkResult taken_over = intake_.Take(Position(a_, spec_, 9));
  EXPECT_EQ(taken_over.fate, ChunkFate::kDealtWith);
  EXPECT_EQ(taken_over.lost, 8u);
  EXPECT_EQ(intake_.Take(a_.Chunk(9, 4)).fate, ChunkFate::kDealtWith);
  const SessionCounters& c = Counters(a_);
  EXPECT_EQ(c.highest, 12u);
  EXPECT_EQ(c.lost, 8u);
  EXPECT_EQ(c.stored() + c.rejected + c.after_gap, 4u);
}

TEST_F(IntakeTest, WhatOnlyThisServerCanHaveStoredIsNeverTakenAsLost) {
  intake_.Take(a_.Chunk(1, 4));
  EXPECT_EQ(intake_.Take(Position(a_, spec_, 9)).fate, ChunkFate::kAhead);
  EXPECT_EQ(intake_.Take(Position(a_, spec_, 5)).fate, ChunkFate::kDealtWith);
  EXPECT_EQ(intake_.Take(Position(a_, spec_, 1)).fate, ChunkFate::kDealtWith);
  EXPECT_EQ(Counters(a_).highest, 4u);
  EXPECT_EQ(Counters(a_).lost, 0u);
}

TEST_F(IntakeTest, AnInheritedSessionIsLostAndGoesOn) {
  SessionTable sessions(ring_.sessions());
  sessions.TakeOver({.sessions = {{.actor = 0, .session = 10, .highest = 6, .rejected = 1},
                                  {.actor = 1, .session = 11, .highest = 3}}});
  Intake intake(spec_.Hash(), &ring_, &sessions, &index_);
  EXPECT_EQ(sessions.at(0).lost, 5u);
  EXPECT_EQ(sessions.at(0).stored(), 0u);
  // The old server's account was a second old: it had stored up to 8 by its end.
  EXPECT_EQ(intake.Take(Position(a_, spec_, 9)).lost, 2u);
  EXPECT_EQ(intake.Take(a_.Chunk(9, 2)).fate, ChunkFate::kDealtWith);
  EXPECT_EQ(sessions.at(0).highest, 10u);
  EXPECT_EQ(sessions.at(0).lost, 7u);
  EXPECT_EQ(sessions.at(1).lost, 3u) << "its actor is gone";
}

TEST_F(IntakeTest, AGapClosesTheEpisodeAtTheLastStoredRecord) {
  intake_.Take(Chunk(1, {Record(0, 0, 1), Record(0, 1, 2)}));
  SessionTable sessions(ring_.sessions());  // a new server on the same ring
  Intake intake(spec_.Hash(), &ring_, &sessions, &index_);
  TransitionChunk position = Chunk(4, {});
  EXPECT_EQ(intake.Take(position).lost, 1u);
  intake.Take(Chunk(4, {Record(0, 3, 4), Record(0, 4, 5), Record(1, 0, 6), Record(1, 1, 7)}));
  const SessionCounters& c = sessions.at(0);
  EXPECT_EQ(c.lost, 1u);
  EXPECT_EQ(c.after_gap, 2u);
  EXPECT_EQ(c.stored(), 4u);
  EXPECT_EQ(index_.cut_episodes(), 1u);
  EXPECT_EQ(index_.sampleable(), 2u);
}

TEST_F(IntakeTest, ASessionFromTheFutureIsRefusedAndDoesNotSupersede) {
  RecordScript forged(spec_, 0, uint64_t{1} << 63);
  EXPECT_EQ(intake_.Take(a_.Chunk(1, 2), /*latest_session=*/20).fate, ChunkFate::kDealtWith);
  EXPECT_EQ(intake_.Take(forged.Chunk(1, 2), 20).fate, ChunkFate::kFuture);
  EXPECT_EQ(intake_.Take(Position(forged, spec_, 1000), 20).fate, ChunkFate::kFuture);
  EXPECT_EQ(intake_.Take(a_.Chunk(3, 2), 20).stored, 2u);
  EXPECT_EQ(sessions_.size(), 1);
}

TEST_F(IntakeTest, AnActorWhoseClockWasSetBackFollowsItsFormerSession) {
  intake_.Take(a_.Chunk(1, 2));
  RecordScript next(spec_, 0, 10 + ChunkIntake::kSessionStep),
      leap(spec_, 1, 12 + ChunkIntake::kSessionStep);
  EXPECT_EQ(intake_.Take(next.Chunk(1, 2), /*latest_session=*/5).fate, ChunkFate::kDealtWith);
  intake_.Take(b_.Chunk(1, 2));
  EXPECT_EQ(intake_.Take(leap.Chunk(1, 2), 5).fate, ChunkFate::kFuture);
}

TEST_F(IntakeTest, AMalformedRecordIsCountedAndClosesItsEpisode) {
  auto bad = Record(0, 2, 3);
  RecordLayout::Header(bad.data()).reward = std::numeric_limits<float>::quiet_NaN();
  // The same index once more, well-formed: the episode is closed all the same.
  const ChunkResult result =
      intake_.Take(Chunk(1, {Record(0, 0, 1), Record(0, 1, 2), bad, Record(0, 2, 4),
                             Record(0, 3, 5), Record(1, 0, 6)}));
  EXPECT_EQ(result.rejected, 1u);
  EXPECT_STREQ(result.fault, "reward is not finite");
  EXPECT_EQ(result.after_gap, 2u);
  EXPECT_EQ(result.stored, 3u);
  EXPECT_EQ(sessions_.at(0).highest, 6u);
}

TEST_F(IntakeTest, ARecordWithAnotherSequenceThanItsPlaceIsRejected) {
  EXPECT_EQ(intake_.Take(Chunk(1, {Record(0, 0, 1), Record(0, 1, 9)})).rejected, 1u);
}

TEST_F(IntakeTest, NothingFollowsTheEndOfAnEpisode) {
  const ChunkResult result =
      intake_.Take(Chunk(1, {Record(0, 0, 1), Record(0, 1, 2, kTruncated), Record(0, 2, 3)}));
  EXPECT_EQ(result.stored, 2u);
  EXPECT_EQ(result.after_gap, 1u);
}

TEST_F(IntakeTest, ANewSessionOfTheActorNeverContinuesTheFormerOnesEpisode) {
  intake_.Take(Chunk(1, {Record(0, 0, 1), Record(0, 1, 2)}));
  TransitionChunk chunk = Chunk(1, {Record(0, 2, 1), Record(1, 0, 2), Record(1, 1, 3)});
  chunk.session = 71;
  const ChunkResult result = intake_.Take(chunk);
  EXPECT_EQ(result.after_gap, 1u);
  EXPECT_EQ(result.stored, 2u);
  EXPECT_EQ(ring_.Slot(3).prev, 0u);
}

TEST_F(IntakeTest, RefusesLateChunksOfASupersededSession) {
  RecordScript old_session(spec_, 0, 9);
  intake_.Take(old_session.Chunk(1, 3));
  intake_.Take(a_.Chunk(1, 3));
  EXPECT_EQ(intake_.Take(old_session.Chunk(4, 3)).fate, ChunkFate::kSuperseded);
  EXPECT_EQ(Counters(old_session).highest, 3u);
}

TEST_F(IntakeTest, CountsARecordWhoseWriterDiedBeforeItCouldCountIt) {
  intake_.Take(a_.Chunk(1, 3));
  const auto prev =
      index_.Predecessor(0, 10, RecordLayout::Header(a_.At(4).data()));  // and no more than this:
  ring_.Append(0, 10, *prev, a_.At(4).data());
  SessionTable sessions(ring_.sessions());
  EpisodeIndex index(ring_, {});
  ASSERT_EQ(sessions.at(0).highest, 3u);
  Intake intake(spec_.Hash(), &ring_, &sessions, &index);
  EXPECT_EQ(sessions.at(0).highest, 4u);
  EXPECT_EQ(sessions.at(0).stored(), 4u);
  const ChunkResult result = intake.Take(a_.Chunk(4, 2));
  EXPECT_EQ(result.duplicates, 1u);
  EXPECT_EQ(result.stored, 1u);
}

TEST_F(IntakeTest, AnInheritedTableOutlivesNothingButItself) {
  SessionTable sessions(ring_.sessions());
  sessions.TakeOver({.sessions = {{.actor = 0, .session = 10, .highest = 6}}});
  EXPECT_EQ(SessionTable(ring_.sessions()).at(0), sessions.at(0)) << "it is in the ring";
}

TEST_F(IntakeTest, RefusesChunksOfAnotherSpecAndMalformedOnes) {
  TransitionChunk chunk = a_.Chunk(1, 3);
  chunk.spec_hash ^= 1;
  EXPECT_EQ(intake_.Take(chunk).fate, ChunkFate::kWrongSpec);
  chunk = a_.Chunk(1, 3);
  chunk.payload = chunk.payload.subspan(8);
  EXPECT_EQ(intake_.Take(chunk).fate, ChunkFate::kMalformed);
  chunk = a_.Chunk(1, 3);
  chunk.first_sequence = 0;
  EXPECT_EQ(intake_.Take(chunk).fate, ChunkFate::kMalformed);
  chunk = a_.Chunk(1, 3);
  chunk.first_sequence = UINT64_MAX - 1;
  EXPECT_EQ(intake_.Take(chunk).fate, ChunkFate::kMalformed);
  EXPECT_EQ(ring_.last_id(), 0u);
  EXPECT_EQ(sessions_.size(), 0);
}

TEST_F(IntakeTest, RefusesNewSessionsWhenTheTableIsFull) {
  for (uint32_t actor = 0; actor < kMaxSessions; ++actor) {
    RecordScript script(spec_, actor, 1);
    ASSERT_EQ(intake_.Take(script.Chunk(1, 1)).fate, ChunkFate::kDealtWith);
  }
  RecordScript one_more(spec_, kMaxSessions, 1);
  EXPECT_EQ(intake_.Take(one_more.Chunk(1, 1)).fate, ChunkFate::kTableFull);
}

}  // namespace
}  // namespace shoal::replay
