// SPDX-License-Identifier: Apache-2.0
#include "actor/sending/chunk_sender.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/actor/sending/fake_link.h"

namespace shoal::actor {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::AllOf;
using testing::HasSubstr;

constexpr uint64_t kSpec = 9, kChunkSession = 77;

class ChunkSenderTest : public testing::Test {
 protected:
  void Make(int records) {
    for (int i = 0; i < records; ++i) {
      window_.BeginRecord();
      window_.EndRecord(++made_);
    }
  }
  void Grant(uint64_t stored, uint64_t allowed, uint64_t replay = 1, uint64_t spec = kSpec) {
    link_.credits.push_back({.replay_session = replay,
                             .actor = 0,
                             .session = kChunkSession,
                             .stored = stored,
                             .allowed = allowed,
                             .spec_hash = spec});
  }
  void Pass(SteadyTime::duration time) {
    clock_.now += time;
    sender_.Exchange(clock_.now);
  }

  FakeClock clock_;
  FakeLink link_{clock_};
  ChunkWindow window_{{.spec_hash = kSpec,
                       .session = kChunkSession,
                       .record_bytes = 16,
                       .chunk_records = 4,
                       .chunks = 4,
                       .first_records = 12}};
  ChunkSender sender_{window_,
                      link_,
                      {.spec_hash = kSpec,
                       .spec_summary = "ours",
                       .flush_after = milliseconds(100),
                       .now = clock_.Reader()}};
  uint64_t made_ = 0;
};

TEST_F(ChunkSenderTest, WholeChunksGoOutAtOnceAndPartialOnesInTime) {
  Make(6);
  sender_.Exchange(clock_.now);
  ASSERT_EQ(link_.sent.size(), 1u);
  EXPECT_EQ(link_.sent[0].last, 4u);
  Pass(milliseconds(99));
  EXPECT_EQ(link_.sent.size(), 1u);
  Pass(milliseconds(1));
  ASSERT_EQ(link_.sent.size(), 2u);
  EXPECT_EQ(link_.sent[1].first, 5u);
  EXPECT_EQ(link_.sent[1].last, 6u);
}

TEST_F(ChunkSenderTest, WithoutAReceiverNothingIsSentAndNothingLost) {
  link_.connected = false;
  Make(4);
  sender_.Exchange(clock_.now);
  EXPECT_TRUE(link_.sent.empty());
  link_.connected = true;
  sender_.Exchange(clock_.now);
  EXPECT_EQ(link_.sent.size(), 1u);
}

TEST_F(ChunkSenderTest, WhatTheTransportDoesNotTakeIsKeptAndCounted) {
  link_.taking = false;
  Make(8);
  sender_.Exchange(clock_.now);
  EXPECT_EQ(sender_.write_timeouts(), 1u) << "the second chunk waits for the first";
  link_.taking = true;
  sender_.Exchange(clock_.now);
  ASSERT_EQ(link_.sent.size(), 2u);
  EXPECT_EQ(link_.sent[0].first, 1u);
  EXPECT_EQ(window_.resent_records(), 0u);
}

TEST_F(ChunkSenderTest, SendsAgainWhatIsNotStoredForTooLong) {
  Make(8);
  sender_.Exchange(clock_.now);
  ASSERT_EQ(link_.sent.size(), 2u);
  Pass(ChunkSender::kResendAfter);
  EXPECT_EQ(link_.sent.size(), 2u) << "not yet";
  Grant(4, 12);
  Pass(milliseconds(1));
  EXPECT_EQ(link_.sent.size(), 2u) << "progress starts the wait anew";
  Pass(ChunkSender::kResendAfter);
  EXPECT_EQ(link_.sent.size(), 2u);
  Pass(milliseconds(1));
  ASSERT_EQ(link_.sent.size(), 3u);
  EXPECT_EQ(link_.sent[2].first, 5u) << "what is stored is not sent again";
  EXPECT_EQ(window_.resent_records(), 4u);
  Pass(ChunkSender::kResendAfter);
  EXPECT_EQ(link_.sent.size(), 3u) << "once per wait";
  Pass(milliseconds(1));
  EXPECT_EQ(link_.sent.size(), 4u);
}

TEST_F(ChunkSenderTest, TheSameCreditAgainIsNoProgress) {
  Make(4);
  sender_.Exchange(clock_.now);
  for (int i = 0; i < 5; ++i) {
    Grant(0, 12);
    Pass(milliseconds(500));
  }
  EXPECT_EQ(link_.sent.size(), 2u);
}

TEST_F(ChunkSenderTest, NothingIsResentWhileNothingWasSent) {
  Pass(seconds(100));
  Make(4);
  sender_.Exchange(clock_.now);
  sender_.Exchange(clock_.now);
  EXPECT_EQ(link_.sent.size(), 1u) << "the wait begins when there is something to wait for";
  EXPECT_EQ(window_.resent_records(), 0u);
}

// The credit is used up, all records are acknowledged, and the replay that sent this is dead.
TEST_F(ChunkSenderTest, InSilenceItSaysWhereItStands) {
  Make(4);
  sender_.Exchange(clock_.now);
  Grant(4, 4);
  Pass(milliseconds(1));
  for (int i = 0; i < 5; ++i) {
    Grant(4, 4);  // a replay that withholds credit repeats itself
    Pass(seconds(1));
  }
  EXPECT_TRUE(link_.positions.empty());
  Pass(ChunkSender::kResendAfter + milliseconds(1));
  EXPECT_EQ(link_.positions, std::vector<uint64_t>{5});
  EXPECT_EQ(link_.sent.size(), 1u) << "nothing is kept";
  Pass(ChunkSender::kResendAfter + milliseconds(1));
  EXPECT_EQ(link_.positions.size(), 2u) << "until it is heard";
}

TEST_F(ChunkSenderTest, AProcessWithTheSameNumberThatBeganLaterEndsThisOne) {
  Grant(0, 0);
  link_.credits.back().superseded_by = kChunkSession + 5;
  try {
    sender_.Exchange(clock_.now);
    FAIL() << "went on";
  } catch (const SupersededError& e) {
    EXPECT_EQ(e.session(), kChunkSession + 5);
    EXPECT_THAT(e.what(), AllOf(HasSubstr("actor 0"), HasSubstr("82")));
  }
}

TEST_F(ChunkSenderTest, AnotherSpecIsRefusedNamingBoth) {
  Grant(0, 12, 1, 0xabc);
  try {
    sender_.Exchange(clock_.now);
    FAIL() << "took a credit for other observations";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("0000000000000abc"), HasSubstr("0000000000000009"),
                                HasSubstr("[ours]")));
  }
}

TEST_F(ChunkSenderTest, WaitsForACreditUntilTheDeadline) {
  const SteadyTime start = clock_.now;
  sender_.Exchange(start + milliseconds(5));
  EXPECT_EQ(clock_.now - start, milliseconds(5));
}

}  // namespace
}  // namespace shoal::actor
