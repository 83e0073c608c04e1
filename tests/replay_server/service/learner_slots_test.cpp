// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/learner_slots.h"

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>

namespace shoal::replay {
namespace {

constexpr uint64_t kBatchBytes = 640;

class LearnerSlotsTest : public testing::Test {
 protected:
  static SampleRequest Request(uint64_t session, uint64_t request, uint64_t released = 0) {
    return {.learner_session = session,
            .request = request,
            .batch = 1,
            .released = released,
            .takes_slots = true};
  }
  // The batch of a request, all bytes `value`.
  BatchSlot Fill(uint64_t request, uint8_t value) {
    uint8_t* slot = slots_.writer()->FreeSlot();
    if (slot == nullptr) throw std::runtime_error("no free slot");
    std::memset(slot, value, kBatchBytes);
    return slots_.writer()->Fill(request, 10, 9);
  }

  uint64_t room_ = 1'000'000;
  LearnerSlots slots_{1, kBatchBytes, 2, [this] { return MemoryRoom{room_, "a test"}; }};
};

TEST_F(LearnerSlotsTest, ThereAreNoneBeforeALearnerAsks) {
  EXPECT_EQ(slots_.writer(), nullptr);
  EXPECT_EQ(slots_.held(), 0u);
}

TEST_F(LearnerSlotsTest, ALearnerThatTakesThemGetsThemAndGivesThemBack) {
  slots_.OnRequest(Request(5, 1));
  ASSERT_NE(slots_.writer(), nullptr);
  Fill(1, 1);
  Fill(2, 2);
  EXPECT_EQ(slots_.held(), 2u);
  EXPECT_EQ(slots_.writer()->FreeSlot(), nullptr);
  slots_.OnRequest(Request(5, 3, /*released=*/1));
  EXPECT_EQ(slots_.held(), 1u);
  EXPECT_NE(slots_.writer()->FreeSlot(), nullptr);
}

TEST_F(LearnerSlotsTest, ItIsKnownBeforehandWhichRequestGivesTheSlotsUp) {
  EXPECT_FALSE(slots_.GivesUp(Request(5, 1))) << "there are none";
  slots_.OnRequest(Request(5, 1));
  EXPECT_FALSE(slots_.GivesUp(Request(5, 2)));
  EXPECT_FALSE(slots_.GivesUp(Request(4, 1))) << "a former learner changes nothing";
  EXPECT_TRUE(slots_.GivesUp(Request(6, 1)));
  SampleRequest refusal = Request(5, 1);
  refusal.refused_token = 12345;  // of a replay before
  EXPECT_FALSE(slots_.GivesUp(refusal));
  refusal.refused_token = slots_.writer()->address().token[0];
  EXPECT_TRUE(slots_.GivesUp(refusal));
  refusal.learner_session = 4;
  EXPECT_FALSE(slots_.GivesUp(refusal));
}

TEST_F(LearnerSlotsTest, ALearnerThatTakesNoneGetsNone) {
  SampleRequest request = Request(5, 1);
  request.takes_slots = false;
  slots_.OnRequest(request);
  EXPECT_EQ(slots_.writer(), nullptr);
}

TEST_F(LearnerSlotsTest, WithoutRoomThereAreNone) {
  room_ = SlotWriter::MemoryBytes(kBatchBytes, 2) - 1;
  slots_.OnRequest(Request(5, 1));
  EXPECT_EQ(slots_.writer(), nullptr);
  ++room_;
  slots_.OnRequest(Request(5, 2));
  EXPECT_EQ(slots_.writer(), nullptr) << "what is said of a session holds for it";
  slots_.OnRequest(Request(6, 1));
  EXPECT_NE(slots_.writer(), nullptr);
}

TEST_F(LearnerSlotsTest, WhatALearnerCannotOpenItDoesNotGetAgain) {
  slots_.OnRequest(Request(5, 1));
  SampleRequest refusal = Request(5, 1);
  refusal.refused_token = 12345;  // of a replay before
  slots_.OnRequest(refusal);
  ASSERT_NE(slots_.writer(), nullptr);
  refusal.refused_token = slots_.writer()->address().token[0];
  slots_.OnRequest(refusal);
  EXPECT_EQ(slots_.writer(), nullptr);
  slots_.OnRequest(Request(5, 2));
  EXPECT_EQ(slots_.writer(), nullptr);
}

// A stopped or slow reader of an old session's slot still reads its old content.
TEST_F(LearnerSlotsTest, ANewLearnerGetsOtherMemory) {
  slots_.OnRequest(Request(5, 1));
  const BatchSlot word = Fill(1, 0x11);
  Fill(2, 0x22);
  const SlotReader former(word.address, 5, kBatchBytes);
  const uint8_t* batch = former.Batch(word.slot, 1);
  slots_.OnRequest(Request(6, 1));
  EXPECT_EQ(slots_.held(), 0u) << "a dead learner's slots come back";
  EXPECT_NE(slots_.writer()->address().token[0], word.address.token[0]);
  Fill(1, 0x33);
  Fill(2, 0x44);
  for (uint64_t i = 0; i < kBatchBytes; ++i) ASSERT_EQ(batch[i], 0x11) << i;
}

TEST_F(LearnerSlotsTest, AWordOfAFormerLearnerReleasesNothing) {
  slots_.OnRequest(Request(6, 1));
  Fill(1, 1);
  slots_.OnRequest(Request(5, 9, /*released=*/8));
  EXPECT_EQ(slots_.held(), 1u);
}

}  // namespace
}  // namespace shoal::replay
