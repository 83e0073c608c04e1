// SPDX-License-Identifier: Apache-2.0
#include "common/wire/batch_slots.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <stdexcept>

#include "tests/support/error_message.h"

namespace shoal {
namespace {

using ::testing::HasSubstr;

constexpr uint64_t kSpec = 3, kSession = 7, kBatchBytes = 5'056;

class BatchSlotsTest : public testing::Test {
 protected:
  // Fills a free slot with `value` as the batch of `request`.
  BatchSlot Fill(uint64_t request, uint8_t value = 1) {
    uint8_t* slot = writer_.FreeSlot();
    if (slot == nullptr) throw std::runtime_error("no free slot");
    std::memset(slot, value, kBatchBytes);
    return writer_.Fill(request, 100, 90, 7);
  }
  SlotReader Reader() const { return {writer_.address(), kSession, kBatchBytes}; }

  // Overwrites bytes of the memory behind the writer's back.
  template <class T>
  void Overwrite(off_t offset, T value) {
    const std::string path = fmt::format("/proc/self/fd/{}", writer_.address().descriptor);
    const int fd = open(path.c_str(), O_RDWR | O_CLOEXEC);
    ASSERT_GE(fd, 0);
    ASSERT_EQ(pwrite(fd, &value, sizeof value, offset), ssize_t{sizeof value});
    close(fd);
  }
  std::string WhyNotRead() const {
    return ErrorMessage([&] { Reader(); });
  }

  SlotWriter writer_{kSpec, kSession, kBatchBytes, 3};
};

TEST_F(BatchSlotsTest, ABatchIsReadWhereItWasWritten) {
  const BatchSlot first = Fill(1, 0x11), second = Fill(2, 0x22);
  EXPECT_EQ(first.spec_hash, kSpec);
  EXPECT_EQ(first.learner_session, kSession);
  EXPECT_EQ(first.request, 1u);
  EXPECT_EQ(first.stored_records, 100u);
  EXPECT_EQ(first.stored_steps, 90u);
  EXPECT_EQ(first.unsampleable_steps, 7u);
  EXPECT_EQ(first.address, writer_.address());
  const SlotReader reader = Reader();
  for (const auto& [word, value] : {std::pair(first, 0x11), std::pair(second, 0x22)}) {
    const uint8_t* batch = reader.Batch(word.slot, word.request);
    EXPECT_EQ(reinterpret_cast<uintptr_t>(batch) % 64, 0u);
    EXPECT_EQ(batch[0], value);
    EXPECT_EQ(batch[kBatchBytes - 1], value);
  }
}

TEST_F(BatchSlotsTest, ASlotIsWrittenAgainOnlyOnceItIsReleased) {
  const uint32_t slot = Fill(1).slot;
  Fill(2);
  Fill(3);
  EXPECT_EQ(writer_.held(), 3u);
  EXPECT_EQ(writer_.FreeSlot(), nullptr);
  writer_.Release(0);
  EXPECT_EQ(writer_.FreeSlot(), nullptr);
  writer_.Release(1);
  EXPECT_EQ(writer_.held(), 2u);
  EXPECT_EQ(Fill(4).slot, slot);
  writer_.Release(1);  // a late message
  EXPECT_EQ(writer_.held(), 3u);
  writer_.Release(4);
  EXPECT_EQ(writer_.held(), 0u);
}

TEST_F(BatchSlotsTest, SeveralSlotsAreWrittenAtOneTimeAndFilledInAnyOrder) {
  uint8_t* const first = writer_.FreeSlot();
  writer_.Reserve(1);
  uint8_t* const second = writer_.FreeSlot();
  writer_.Reserve(2);
  EXPECT_NE(first, second);
  EXPECT_EQ(writer_.held(), 2u);
  EXPECT_FALSE(writer_.Held(1)) << "it is not full yet";
  writer_.Release(9);
  EXPECT_EQ(writer_.held(), 2u) << "a slot that is still written cannot be released";
  first[0] = 0x11;
  second[0] = 0x22;
  const BatchSlot late = writer_.Fill(2, 100, 90), early = writer_.Fill(1, 100, 90);
  const SlotReader reader = Reader();
  EXPECT_EQ(reader.Batch(early.slot, 1)[0], 0x11);
  EXPECT_EQ(reader.Batch(late.slot, 2)[0], 0x22);
  EXPECT_TRUE(writer_.Held(1) && writer_.Held(2));
  writer_.Release(2);
  EXPECT_EQ(writer_.held(), 0u);
}

TEST_F(BatchSlotsTest, WhatIsHeldIsSaidAgainInTheSameWords) {
  const BatchSlot word = Fill(5);
  const auto again = writer_.Held(5);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->slot, word.slot);
  EXPECT_EQ(again->request, 5u);
  EXPECT_EQ(again->stored_records, word.stored_records);
  EXPECT_EQ(again->stored_steps, word.stored_steps);
  EXPECT_EQ(again->unsampleable_steps, word.unsampleable_steps);
  EXPECT_FALSE(writer_.Held(4));
  EXPECT_FALSE(writer_.Held(0));
  writer_.Release(5);
  EXPECT_FALSE(writer_.Held(5));
}

TEST_F(BatchSlotsTest, ASlotThatIsBeingWrittenIsNotRead) {
  const SlotReader reader = Reader();
  const uint32_t slot = Fill(1).slot;
  writer_.Release(1);
  ASSERT_NE(writer_.FreeSlot(), nullptr);
  EXPECT_THAT(ErrorMessage([&] { reader.Batch(slot, 1); }), HasSubstr("does not hold"));
  EXPECT_THAT(ErrorMessage([&] { reader.Batch(slot, 2); }), HasSubstr("does not hold"));
  writer_.Fill(2, 100, 90);
  EXPECT_NO_THROW(reader.Batch(slot, 2));
  EXPECT_THAT(ErrorMessage([&] { reader.Batch(3, 2); }), HasSubstr("slot 3 of 3"));
}

TEST_F(BatchSlotsTest, AnotherTokenIsNotTheReplays) {
  for (const int half : {0, 1}) {
    SlotAddress other = writer_.address();
    other.token[half] ^= 2;
    EXPECT_THAT(ErrorMessage([&] { SlotReader(other, kSession, kBatchBytes); }),
                HasSubstr("is not the replay's"));
  }
  const SlotWriter second(kSpec, kSession, kBatchBytes, 3);
  EXPECT_NE(second.address().token[0], writer_.address().token[0]);
  EXPECT_NE(second.address().token[1], writer_.address().token[1]);
}

TEST_F(BatchSlotsTest, SlotsOfAnotherSessionOrSizeAreNotRead) {
  EXPECT_THAT(ErrorMessage([&] { SlotReader(writer_.address(), kSession + 1, kBatchBytes); }),
              HasSubstr("for session 7; expected batches of 5056 bytes for session 8"));
  EXPECT_THAT(ErrorMessage([&] { SlotReader(writer_.address(), kSession, kBatchBytes + 64); }),
              HasSubstr("3 slots of 5056 bytes"));
}

TEST_F(BatchSlotsTest, GarbageInTheHeaderIsRefused) {
  EXPECT_EQ(WhyNotRead(), "");
  Overwrite<uint64_t>(0, 42);
  EXPECT_THAT(WhyNotRead(), HasSubstr("is not the replay's"));
  Overwrite<uint64_t>(0, 0x314c534c414f4853);
  EXPECT_EQ(WhyNotRead(), "");
  for (const uint32_t slots : {0u, 2u, 4u, 0xffffffffu}) {
    Overwrite<uint32_t>(40, slots);
    EXPECT_THAT(WhyNotRead(), HasSubstr(fmt::format("has {} slots", slots)));
  }
}

TEST_F(BatchSlotsTest, GarbageInAWordIsNoBatch) {
  const BatchSlot word = Fill(1);
  Overwrite<uint64_t>(64 + 8 * word.slot, ~uint64_t{0});
  const SlotReader reader = Reader();
  EXPECT_THAT(ErrorMessage([&] { reader.Batch(word.slot, 1); }), HasSubstr("does not hold"));
}

}  // namespace
}  // namespace shoal
