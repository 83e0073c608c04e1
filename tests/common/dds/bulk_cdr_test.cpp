// SPDX-License-Identifier: Apache-2.0
#include "common/dds/bulk_cdr.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

namespace shoal::dds {
namespace {

// Writes what a sender writes, independently of idlc: fields aligned to their size.
class CdrWriter {
 public:
  CdrWriter() : bytes_{0x00, 0x01, 0x00, 0x00} {}

  template <class T>
  CdrWriter& Put(T value) {
    while ((bytes_.size() - 4) % sizeof(T) != 0) bytes_.push_back(0);
    const auto* begin = reinterpret_cast<const uint8_t*>(&value);
    bytes_.insert(bytes_.end(), begin, begin + sizeof(T));
    return *this;
  }
  CdrWriter& PutBytes(const std::string& bytes) {
    Put<uint32_t>(static_cast<uint32_t>(bytes.size()));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  CdrWriter& PutString(const std::string& text) { return PutBytes(text + std::string(1, '\0')); }
  const std::vector<uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<uint8_t> bytes_;
};

struct ChunkFields {
  uint8_t version = 1;
  uint32_t count = 2;
  uint64_t first_sequence = 101;
  std::string payload = "abcdefgh";
};

std::vector<uint8_t> Chunk(const ChunkFields& fields) {
  return CdrWriter()
      .Put<uint8_t>(fields.version)
      .Put<uint32_t>(7)
      .Put<uint64_t>(0x1122334455667788)
      .Put<uint64_t>(9)
      .Put<uint64_t>(fields.first_sequence)
      .Put<uint32_t>(fields.count)
      .PutBytes(fields.payload)
      .bytes();
}

struct PartFields {
  uint32_t part = 1, parts = 3;
  uint64_t offset = 8, total_bytes = 20;
  std::string payload = "abcdefgh";
};

std::vector<uint8_t> Part(const PartFields& fields) {
  return CdrWriter()
      .Put<uint8_t>(2)
      .Put<uint32_t>(fields.part)
      .Put<uint64_t>(11)
      .Put<uint64_t>(12)
      .Put<uint64_t>(13)
      .Put<uint64_t>(fields.offset)
      .Put<uint64_t>(fields.total_bytes)
      .Put<uint64_t>(16)
      .Put<uint64_t>(17)
      .Put<uint64_t>(18)
      .Put<uint32_t>(fields.parts)
      .PutBytes(fields.payload)
      .bytes();
}

std::vector<uint8_t> Weights(uint64_t session, const std::string& payload,
                             const std::string& checkpoint) {
  return CdrWriter()
      .Put<uint8_t>(2)
      .Put<uint32_t>(20)
      .Put<uint64_t>(21)
      .Put<uint64_t>(session)
      .Put<uint64_t>(23)
      .Put<uint64_t>(24)
      .Put<uint64_t>(26)
      .Put<uint32_t>(25)
      .PutBytes(payload)
      .PutString(checkpoint)
      .bytes();
}

template <class M>
bool Accepts(const std::vector<uint8_t>& cdr) {
  // An exact-size copy on the heap: a read beyond the end is seen by a sanitizer.
  const std::vector<uint8_t> exact(cdr.begin(), cdr.end());
  M message;
  return ParseCdr(std::span<const uint8_t>(exact), &message);
}

template <class M>
void ExpectEveryTruncationRefused(const std::vector<uint8_t>& cdr) {
  for (size_t size = 0; size < cdr.size(); ++size) {
    EXPECT_FALSE(Accepts<M>({cdr.begin(), cdr.begin() + static_cast<ptrdiff_t>(size)})) << size;
  }
}

std::string Text(std::span<const uint8_t> bytes) { return {bytes.begin(), bytes.end()}; }

TEST(BulkCdr, ReadsTheDocumentedBytesOfAChunk) {
  const std::vector<uint8_t> golden = {
      0x00, 0x01, 0x00, 0x00,                          // CDR, little-endian
      0x01, 0x00, 0x00, 0x00,                          // version, padding
      0x07, 0x00, 0x00, 0x00,                          // actor
      0x88, 0x77, 0x66, 0x55, 0x44, 0x33, 0x22, 0x11,  // spec_hash
      0x09, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // session
      0x65, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // first_sequence
      0x02, 0x00, 0x00, 0x00,                          // count
      0x08, 0x00, 0x00, 0x00,                          // payload size
      'a',  'b',  'c',  'd',  'e',  'f',  'g',  'h'};
  EXPECT_EQ(golden, Chunk({}));
  TransitionChunk chunk;
  ASSERT_TRUE(ParseCdr(std::span<const uint8_t>(golden), &chunk));
  EXPECT_EQ(chunk.actor, 7u);
  EXPECT_EQ(chunk.spec_hash, 0x1122334455667788u);
  EXPECT_EQ(chunk.session, 9u);
  EXPECT_EQ(chunk.first_sequence, 101u);
  EXPECT_EQ(chunk.count, 2u);
  EXPECT_EQ(Text(chunk.payload), "abcdefgh");
}

TEST(BulkCdr, ReadsEveryFieldOfAPart) {
  const std::vector<uint8_t> cdr = Part({});
  BatchPart part;
  ASSERT_TRUE(ParseCdr(std::span<const uint8_t>(cdr), &part));
  EXPECT_EQ(part.part, 1u);
  EXPECT_EQ(part.parts, 3u);
  EXPECT_EQ(part.spec_hash, 11u);
  EXPECT_EQ(part.learner_session, 12u);
  EXPECT_EQ(part.request, 13u);
  EXPECT_EQ(part.offset, 8u);
  EXPECT_EQ(part.total_bytes, 20u);
  EXPECT_EQ(part.stored_records, 16u);
  EXPECT_EQ(part.stored_steps, 17u);
  EXPECT_EQ(part.unsampleable_steps, 18u);
  EXPECT_EQ(Text(part.payload), "abcdefgh");
}

TEST(BulkCdr, ReadsEveryFieldOfWeights) {
  const std::vector<uint8_t> cdr = Weights(22, "tensors", "step_5");
  WeightsPart weights;
  ASSERT_TRUE(ParseCdr(std::span<const uint8_t>(cdr), &weights));
  EXPECT_EQ(weights.spec_hash, 21u);
  EXPECT_EQ(weights.version, (WeightsVersion{22, 23}));
  EXPECT_EQ(weights.part, 20u);
  EXPECT_EQ(weights.env_steps, 24u);
  EXPECT_EQ(weights.total_bytes, 26u);
  EXPECT_EQ(weights.crc, 25u);
  EXPECT_EQ(weights.checkpoint, "step_5");
  EXPECT_EQ(Text(weights.payload), "tensors");
}

TEST(BulkCdr, PayloadIsBorrowedAndStartsAtAMultipleOfEight) {
  const auto offset = [](const std::vector<uint8_t>& cdr, auto message) {
    EXPECT_TRUE(ParseCdr(std::span<const uint8_t>(cdr), &message));
    return message.payload.data() - (cdr.data() + 4);
  };
  EXPECT_EQ(offset(Chunk({}), TransitionChunk{}) % 8, 0);
  EXPECT_EQ(offset(Part({}), BatchPart{}) % 8, 0);
  EXPECT_EQ(offset(Weights(22, "tensors", "step_5"), WeightsPart{}) % 8, 0);
}

TEST(BulkCdr, RefusesEveryTruncation) {
  ExpectEveryTruncationRefused<TransitionChunk>(Chunk({}));
  ExpectEveryTruncationRefused<BatchPart>(Part({}));
  ExpectEveryTruncationRefused<WeightsPart>(Weights(22, "tensors", "step_5"));
}

TEST(BulkCdr, AllowsPaddingButNoFurtherFields) {
  std::vector<uint8_t> cdr = Chunk({});
  cdr.resize(cdr.size() + 3);
  EXPECT_TRUE(Accepts<TransitionChunk>(cdr));
  cdr.push_back(0);
  EXPECT_FALSE(Accepts<TransitionChunk>(cdr));
}

TEST(BulkCdr, RefusesOtherVersionsAndEncodings) {
  EXPECT_TRUE(Accepts<TransitionChunk>(Chunk({})));
  EXPECT_FALSE(Accepts<TransitionChunk>(Chunk({.version = 0})));
  EXPECT_FALSE(Accepts<TransitionChunk>(Chunk({.version = 2})));
  std::vector<uint8_t> cdr = Chunk({});
  cdr[1] = 0x00;  // big-endian
  EXPECT_FALSE(Accepts<TransitionChunk>(cdr));
  cdr[1] = 0x03;  // parameter list
  EXPECT_FALSE(Accepts<TransitionChunk>(cdr));
}

TEST(BulkCdr, RefusesChunksThatContradictThemselves) {
  EXPECT_FALSE(Accepts<TransitionChunk>(Chunk({.count = 0})));
  EXPECT_TRUE(Accepts<TransitionChunk>(Chunk({.count = 0, .payload = ""})));
  EXPECT_FALSE(Accepts<TransitionChunk>(Chunk({.count = 3})));  // 8 bytes are not 3 equal records
  EXPECT_FALSE(Accepts<TransitionChunk>(Chunk({.payload = ""})));
  EXPECT_FALSE(Accepts<TransitionChunk>(Chunk({.first_sequence = 0})));
  EXPECT_FALSE(Accepts<TransitionChunk>(Chunk({.first_sequence = UINT64_MAX})));
}

TEST(BulkCdr, RefusesPartsOutsideTheirBatch) {
  EXPECT_FALSE(Accepts<BatchPart>(Part({.part = 3})));
  EXPECT_TRUE(Accepts<BatchPart>(Part({.offset = 12})));
  EXPECT_FALSE(Accepts<BatchPart>(Part({.offset = 13})));
  EXPECT_FALSE(Accepts<BatchPart>(Part({.offset = 21})));
  EXPECT_FALSE(Accepts<BatchPart>(Part({.offset = UINT64_MAX - 3, .total_bytes = UINT64_MAX})));
  EXPECT_FALSE(Accepts<BatchPart>(Part({.payload = ""})));
}

TEST(BulkCdr, RefusesWeightsWithoutSessionPayloadOrTerminatedName) {
  EXPECT_TRUE(Accepts<WeightsPart>(Weights(22, "tensors", "")));
  EXPECT_FALSE(Accepts<WeightsPart>(Weights(0, "tensors", "")));
  EXPECT_FALSE(Accepts<WeightsPart>(Weights(22, "", "")));
  EXPECT_FALSE(Accepts<WeightsPart>(Weights(22, std::string(27, 'x'), ""))) << "of 26 in all";
  std::vector<uint8_t> cdr = Weights(22, "tensors", "step_5");
  cdr.back() = 'x';
  EXPECT_FALSE(Accepts<WeightsPart>(cdr));
}

TEST(BulkCdr, SurvivesEveryFlippedBit) {
  const std::vector<uint8_t> valid = Weights(22, "tensors", "step_5");
  for (size_t bit = 0; bit < valid.size() * 8; ++bit) {
    std::vector<uint8_t> cdr = valid;
    cdr[bit / 8] = static_cast<uint8_t>(cdr[bit / 8] ^ (1u << (bit % 8)));
    WeightsPart weights;
    if (!ParseCdr(std::span<const uint8_t>(cdr), &weights)) continue;
    EXPECT_LE(weights.payload.data() + weights.payload.size(), cdr.data() + cdr.size()) << bit;
  }
}

TEST(BulkCdr, ACheckpointsNameHoldsNothingThatATerminalWouldObey) {
  const std::vector<uint8_t> cdr = Weights(22, "payload", "step\n\x1b[2J");
  WeightsPart message;
  ASSERT_TRUE(ParseCdr(std::span<const uint8_t>(cdr), &message));
  EXPECT_EQ(message.checkpoint, "step ?[2J");
}

}  // namespace
}  // namespace shoal::dds
