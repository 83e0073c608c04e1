// SPDX-License-Identifier: Apache-2.0
#include "learner/slot_batches.h"

#include <gtest/gtest.h>

#include <cstring>
#include <optional>
#include <stdexcept>

#include "common/base/error.h"

namespace shoal::learner {
namespace {

constexpr uint64_t kSlotSession = 7, kBatchBytes = 640;

class SlotBatchesTest : public testing::Test {
 protected:
  static BatchSlot Fill(SlotWriter& writer, uint64_t request, uint8_t value) {
    uint8_t* slot = writer.FreeSlot();
    if (slot == nullptr) throw std::runtime_error("no free slot");
    std::memset(slot, value, kBatchBytes);
    return writer.Fill(request, request + 10, request + 9);
  }

  std::optional<SlotWriter> replay_{std::in_place, 1, kSlotSession, kBatchBytes, 3};
  SlotBatches batches_{kSlotSession, kBatchBytes};
};

TEST_F(SlotBatchesTest, ABatchIsReadInItsSlot) {
  EXPECT_FALSE(batches_.Has(4));
  EXPECT_EQ(batches_.Add(Fill(*replay_, 4, 0x44)), SlotBatches::Verdict::kTaken);
  EXPECT_EQ(batches_.Add(Fill(*replay_, 5, 0x55)), SlotBatches::Verdict::kTaken);
  ASSERT_TRUE(batches_.Has(4));
  EXPECT_EQ(batches_.stored_records(4), 14u);
  EXPECT_EQ(batches_.stored_steps(4), 13u);
  EXPECT_EQ(batches_.Open(4)[kBatchBytes - 1], 0x44);
  EXPECT_EQ(batches_.Open(5)[0], 0x55);
  batches_.Release(4);
  EXPECT_FALSE(batches_.Has(4));
}

TEST_F(SlotBatchesTest, TheSameWordTwiceIsOneBatch) {
  const BatchSlot word = Fill(*replay_, 4, 1);
  EXPECT_EQ(batches_.Add(word), SlotBatches::Verdict::kTaken);
  EXPECT_EQ(batches_.Add(word), SlotBatches::Verdict::kDuplicate);
}

TEST_F(SlotBatchesTest, ANewReplaysAnswerTakesTheFormersPlace) {
  batches_.Add(Fill(*replay_, 4, 0x11));
  batches_.Add(Fill(*replay_, 5, 0x22));
  SlotWriter successor(1, kSlotSession, kBatchBytes, 3);
  EXPECT_EQ(batches_.Add(Fill(successor, 5, 0x55)), SlotBatches::Verdict::kStartedOver);
  EXPECT_EQ(batches_.Open(4)[0], 0x11);
  EXPECT_EQ(batches_.Open(5)[0], 0x55);
}

TEST_F(SlotBatchesTest, WhatIsOpenOutlivesItsReplay) {
  batches_.Add(Fill(*replay_, 4, 0x11));
  batches_.Add(Fill(*replay_, 5, 0x22));
  batches_.Open(4);
  replay_.reset();
  SlotWriter successor(1, kSlotSession, kBatchBytes, 3);
  batches_.Add(Fill(successor, 6, 0x66));
  EXPECT_EQ(batches_.Open(6)[0], 0x66);
  batches_.Release(4);
  EXPECT_EQ(batches_.Open(5)[0], 0x22) << "its message still means the old memory";
}

TEST_F(SlotBatchesTest, WhatCannotBeOpenedIsRefusedAsAWhole) {
  EXPECT_EQ(batches_.refused_token(), 0u);
  const BatchSlot first = Fill(*replay_, 4, 1), second = Fill(*replay_, 5, 1);
  const BatchSlot third = Fill(*replay_, 6, 1);
  batches_.Add(first);
  batches_.Add(second);
  replay_.reset();
  EXPECT_THROW(batches_.Open(4), Error);
  EXPECT_EQ(batches_.Refuse(4), (std::vector<uint64_t>{4, 5}));
  EXPECT_EQ(batches_.refused_token(), first.address.token[0]);
  EXPECT_FALSE(batches_.Has(5));
  EXPECT_EQ(batches_.Add(third), SlotBatches::Verdict::kRefused);
  EXPECT_FALSE(batches_.Has(6));
  SlotWriter successor(1, kSlotSession, kBatchBytes, 3);
  EXPECT_EQ(batches_.Add(Fill(successor, 6, 0x66)), SlotBatches::Verdict::kTaken)
      << "this one may do";
  EXPECT_EQ(batches_.Open(6)[0], 0x66);
}

}  // namespace
}  // namespace shoal::learner
