// SPDX-License-Identifier: Apache-2.0
#include "learner/slot_batches.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <span>
#include <stdexcept>

#include "common/base/error.h"
#include "tests/learner/recording_pin.h"

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

// A mapping without write access cannot be given write access later, if the memory was opened for
// reading.
bool CanBeWritten(std::span<const uint8_t> memory) {
  return mprotect(const_cast<uint8_t*>(memory.data()), memory.size(), PROT_READ | PROT_WRITE) == 0;
}

TEST_F(SlotBatchesTest, TheMemoryIsPinnedOnceAsAWholeAtItsFirstUse) {
  RecordingPin pin;
  SlotBatches batches(kSlotSession, kBatchBytes, pin.Function());
  for (uint64_t request = 4; request < 7; ++request) batches.Add(Fill(*replay_, request, 1));
  EXPECT_EQ(pin.given.size(), 0u) << "not used yet";
  batches.Open(4);
  ASSERT_EQ(pin.given.size(), 1u);
  for (uint64_t request = 4; request < 7; ++request) {
    const uint8_t* const slot = batches.Open(request);
    EXPECT_GE(slot, pin.given[0].data());
    EXPECT_LE(slot + kBatchBytes, pin.given[0].data() + pin.given[0].size());
    batches.Release(request);
  }
  EXPECT_EQ(pin.given.size(), 1u);
  EXPECT_EQ(pin.pinned, 1);
  EXPECT_TRUE(CanBeWritten(pin.given[0])) << "not every system can pin what may only be read";
}

// RecordingPin checks that each memory is still mapped when its pin ends.
TEST_F(SlotBatchesTest, APinEndsWithItsMemoryAndBeforeIt) {
  RecordingPin pin;
  std::optional<SlotBatches> batches(std::in_place, kSlotSession, kBatchBytes, pin.Function());
  batches->Add(Fill(*replay_, 4, 1));
  batches->Open(4);
  SlotWriter second(1, kSlotSession, kBatchBytes, 3), third(1, kSlotSession, kBatchBytes, 3);
  batches->Add(Fill(second, 5, 1));
  batches->Open(5);
  EXPECT_EQ(pin.pinned, 2) << "the batch of the first memory is in use";
  batches->Release(4);
  EXPECT_EQ(pin.pinned, 1);
  batches->Add(Fill(third, 6, 1));
  batches->Open(6);
  batches->Refuse(5);
  EXPECT_EQ(pin.pinned, 1);
  EXPECT_EQ(pin.given.size(), 3u);
  batches.reset();
  EXPECT_EQ(pin.pinned, 0);
}

TEST_F(SlotBatchesTest, MemoryThatCannotBePinnedIsReadAllTheSame) {
  int asked = 0;
  SlotBatches batches(kSlotSession, kBatchBytes, [&](std::span<const uint8_t>) {
    ++asked;
    return nullptr;
  });
  batches.Add(Fill(*replay_, 4, 0x44));
  batches.Add(Fill(*replay_, 5, 0x55));
  EXPECT_EQ(batches.Open(4)[0], 0x44);
  EXPECT_EQ(batches.Open(5)[0], 0x55);
  EXPECT_EQ(asked, 1);
}

TEST_F(SlotBatchesTest, WithoutAPinTheMemoryIsMappedForReading) {
  batches_.Add(Fill(*replay_, 4, 1));
  uint8_t* const slot = batches_.Open(4);
  uint8_t* const page = slot - reinterpret_cast<uintptr_t>(slot) % 4096;
  EXPECT_EQ(mprotect(page, 1, PROT_READ | PROT_WRITE), -1);
  EXPECT_EQ(errno, EACCES);
}

}  // namespace
}  // namespace shoal::learner
