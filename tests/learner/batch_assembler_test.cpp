// SPDX-License-Identifier: Apache-2.0
#include "learner/batch_assembler.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace shoal::learner {
namespace {

using Verdict = BatchAssembler::Verdict;

constexpr uint64_t kSpec = 11, kSession = 22, kBytes = 256;

// The answer to one request: `parts` equal parts of 256 bytes that count up from `first`.
struct Answer {
  explicit Answer(uint64_t number, uint8_t first = 0, uint32_t count = 4)
      : request(number), parts(count), bytes(kBytes) {
    for (size_t i = 0; i < kBytes; ++i) bytes[i] = static_cast<uint8_t>(first + i);
  }

  BatchPart Part(uint32_t k) const {
    const uint64_t part_bytes = kBytes / parts;
    BatchPart part;
    part.spec_hash = kSpec;
    part.learner_session = kSession;
    part.request = request;
    part.part = k;
    part.parts = parts;
    part.offset = k * part_bytes;
    part.total_bytes = kBytes;
    part.stored_records = stored;
    part.stored_steps = stored - 1;
    part.payload = {bytes.data() + part.offset, part_bytes};
    return part;
  }

  uint64_t request;
  uint32_t parts;
  uint64_t stored = 1000;
  std::vector<uint8_t> bytes;
};

class BatchAssemblerTest : public testing::Test {
 protected:
  // The bytes of a request's batch, empty while it is not whole.
  std::vector<uint8_t> Bytes(uint64_t request) {
    const auto batch = assembler_.TryGet(request);
    if (!batch) return {};
    return {batch->data, batch->data + kBytes};
  }

  BatchAssembler assembler_{kSpec, kSession, kBytes, /*buffers=*/2};
};

TEST_F(BatchAssemblerTest, PutsPartsTogetherInAnyOrder) {
  const Answer answer(1);
  ASSERT_TRUE(assembler_.Expect(1));
  for (const uint32_t k : {2u, 0u, 3u}) {
    EXPECT_EQ(assembler_.Add(answer.Part(k)), Verdict::kTaken);
    EXPECT_FALSE(assembler_.TryGet(1));
  }
  EXPECT_EQ(assembler_.Add(answer.Part(1)), Verdict::kCompleted);
  EXPECT_EQ(Bytes(1), answer.bytes);
  EXPECT_EQ(assembler_.TryGet(1)->stored_records, 1000u);
  EXPECT_EQ(assembler_.TryGet(1)->stored_steps, 999u);
  EXPECT_EQ(reinterpret_cast<uintptr_t>(assembler_.TryGet(1)->data) % 64, 0u);
}

TEST_F(BatchAssemblerTest, KeepsInterleavedBatchesApart) {
  const Answer one(1, 5), two(2, 99);
  ASSERT_TRUE(assembler_.Expect(1));
  ASSERT_TRUE(assembler_.Expect(2));
  for (uint32_t k = 0; k < 4; ++k) {
    assembler_.Add(two.Part(k));
    assembler_.Add(one.Part(3 - k));
  }
  EXPECT_EQ(Bytes(1), one.bytes);
  EXPECT_EQ(Bytes(2), two.bytes);
}

TEST_F(BatchAssemblerTest, ADuplicateChangesNothing) {
  const Answer answer(1);
  Answer forged(1, 77);
  ASSERT_TRUE(assembler_.Expect(1));
  assembler_.Add(answer.Part(0));
  EXPECT_EQ(assembler_.Add(forged.Part(0)), Verdict::kDuplicate);
  for (uint32_t k = 1; k < 4; ++k) assembler_.Add(answer.Part(k));
  EXPECT_EQ(assembler_.Add(forged.Part(2)), Verdict::kDuplicate) << "of a whole batch";
  EXPECT_EQ(Bytes(1), answer.bytes);
}

TEST_F(BatchAssemblerTest, NeverMixesTwoAnswersToARequest) {
  Answer before(1, 0), after(1, 128);
  after.stored = 1010;  // the replay went on before it drew the second one
  ASSERT_TRUE(assembler_.Expect(1));
  assembler_.Add(before.Part(0));
  assembler_.Add(before.Part(1));
  EXPECT_EQ(assembler_.Add(after.Part(3)), Verdict::kStartedOver);
  EXPECT_EQ(assembler_.Add(after.Part(2)), Verdict::kTaken);
  EXPECT_FALSE(assembler_.TryGet(1)) << "four parts, but of two answers";
  assembler_.Add(after.Part(0));
  EXPECT_EQ(assembler_.Add(after.Part(1)), Verdict::kCompleted);
  EXPECT_EQ(Bytes(1), after.bytes);
}

TEST_F(BatchAssemblerTest, RefusesWhatItDidNotAskFor) {
  const Answer unexpected(9);
  ASSERT_TRUE(assembler_.Expect(1));
  EXPECT_EQ(assembler_.Add(unexpected.Part(0)), Verdict::kUnknownRequest);
  BatchPart zero = unexpected.Part(0);
  zero.request = 0;  // the mark of a free buffer must not match
  EXPECT_EQ(assembler_.Add(zero), Verdict::kUnknownRequest);
}

TEST_F(BatchAssemblerTest, RefusesAnswersToAReleasedRequest) {
  const Answer answer(1);
  ASSERT_TRUE(assembler_.Expect(1));
  for (uint32_t k = 0; k < 4; ++k) assembler_.Add(answer.Part(k));
  assembler_.Release(1);
  EXPECT_EQ(assembler_.Add(answer.Part(0)), Verdict::kUnknownRequest);
}

TEST_F(BatchAssemblerTest, RefusesAnotherSessionAndAnotherSpec) {
  ASSERT_TRUE(assembler_.Expect(1));
  BatchPart stale = Answer(1).Part(0), foreign = stale;
  stale.learner_session = kSession - 1;
  foreign.spec_hash = kSpec + 1;
  EXPECT_EQ(assembler_.Add(stale), Verdict::kStaleSession);
  EXPECT_EQ(assembler_.Add(foreign), Verdict::kWrongSpec);
}

TEST_F(BatchAssemblerTest, RefusesSizesThatNoBatchHas) {
  ASSERT_TRUE(assembler_.Expect(1));
  const Answer answer(1);
  const auto verdict = [&](auto change) {
    BatchPart part = answer.Part(1);
    change(part);
    return assembler_.Add(part);
  };
  EXPECT_EQ(verdict([](BatchPart& p) { p.total_bytes = kBytes + 64; }), Verdict::kMalformed);
  EXPECT_EQ(verdict([](BatchPart& p) { p.parts = 0; }), Verdict::kMalformed);
  EXPECT_EQ(verdict([](BatchPart& p) { p.parts = 0xffffffff; }), Verdict::kMalformed);
  EXPECT_EQ(verdict([](BatchPart& p) { p.part = p.parts; }), Verdict::kMalformed);
  EXPECT_EQ(verdict([](BatchPart& p) { p.payload = {}; }), Verdict::kMalformed);
  EXPECT_EQ(verdict([](BatchPart& p) { p.offset = kBytes - 63; }), Verdict::kMalformed);
  EXPECT_EQ(verdict([](BatchPart& p) { p.offset = ~uint64_t{0} - 7; }), Verdict::kMalformed)
      << "offset + size overflows";
  for (uint32_t k = 0; k < 4; ++k) assembler_.Add(answer.Part(k));
  EXPECT_EQ(Bytes(1), answer.bytes) << "what was refused left no trace";
}

TEST_F(BatchAssemblerTest, RefusesPartsThatLeaveAHole) {
  const Answer answer(1);
  ASSERT_TRUE(assembler_.Expect(1));
  for (const uint32_t k : {0u, 1u, 2u}) assembler_.Add(answer.Part(k));
  BatchPart overlapping = answer.Part(3);
  overlapping.offset -= 64;
  EXPECT_EQ(assembler_.Add(overlapping), Verdict::kMalformed);
  EXPECT_FALSE(assembler_.TryGet(1));
  for (uint32_t k = 0; k < 4; ++k) assembler_.Add(answer.Part(k));  // sent again
  EXPECT_EQ(Bytes(1), answer.bytes);
}

TEST_F(BatchAssemblerTest, IsBoundedByItsBuffers) {
  EXPECT_TRUE(assembler_.Expect(1));
  EXPECT_TRUE(assembler_.Expect(2));
  EXPECT_FALSE(assembler_.Expect(3));
  for (uint32_t k = 0; k < 4; ++k) assembler_.Add(Answer(1).Part(k));
  assembler_.Release(1);
  EXPECT_TRUE(assembler_.Expect(3));
  EXPECT_FALSE(assembler_.TryGet(3)) << "nothing of the buffer's former batch shows";
}

}  // namespace
}  // namespace shoal::learner
