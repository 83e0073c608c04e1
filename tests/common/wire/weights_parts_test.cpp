// SPDX-License-Identifier: Apache-2.0
#include "common/wire/weights_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "common/base/crc32.h"
#include "common/base/random.h"

namespace shoal {
namespace {

using Verdict = WeightsAssembler::Verdict;

std::vector<uint8_t> Bytes(uint64_t size, uint64_t seed) {
  std::vector<uint8_t> bytes(size);
  Random random(seed);
  for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random.Next());
  return bytes;
}

WeightsMessage Weights(uint64_t session, uint64_t update, const std::vector<uint8_t>& bytes) {
  WeightsMessage weights;
  weights.version = {session, update};
  weights.checkpoint = "step";
  weights.payload = bytes;
  return weights;
}

std::vector<WeightsPart> Parts(const WeightsMessage& weights) {
  std::vector<WeightsPart> parts;
  for (uint32_t part = 0; part < WeightsParts(weights.payload.size()); ++part) {
    parts.push_back(PartOf<WeightsPart>(weights, part));
  }
  return parts;
}

bool Same(const std::string& taken, const std::vector<uint8_t>& bytes) {
  return std::ranges::equal(taken, bytes, {}, [](char c) { return static_cast<uint8_t>(c); });
}

TEST(WeightsParts, AVersionComesTogetherInAnyOrder) {
  for (const uint64_t size : {uint64_t{1}, kBulkPartBytes - 1, kBulkPartBytes, kBulkPartBytes + 1,
                              5 * kBulkPartBytes + 77}) {
    const std::vector<uint8_t> bytes = Bytes(size, size);
    const WeightsMessage weights = Weights(1, 1, bytes);
    std::vector<WeightsPart> parts = Parts(weights);
    std::ranges::reverse(parts);
    WeightsAssembler assembler;
    for (size_t i = 0; i < parts.size(); ++i) {
      EXPECT_EQ(parts[i].checkpoint, "step");
      EXPECT_EQ(assembler.Add(parts[i]),
                i + 1 == parts.size() ? Verdict::kComplete : Verdict::kTaken);
    }
    EXPECT_TRUE(Same(assembler.Take(), bytes)) << size;
  }
}

TEST(WeightsParts, NothingOfTwoVersionsIsMixed) {
  const std::vector<uint8_t> old_bytes = Bytes(3 * kBulkPartBytes, 1),
                             new_bytes = Bytes(3 * kBulkPartBytes, 2);
  const std::vector<WeightsPart> old_parts = Parts(Weights(1, 10, old_bytes)),
                                 new_parts = Parts(Weights(1, 11, new_bytes));
  WeightsAssembler assembler;
  EXPECT_EQ(assembler.Add(old_parts[0]), Verdict::kTaken);
  EXPECT_EQ(assembler.Add(new_parts[1]), Verdict::kTaken);
  EXPECT_EQ(assembler.Add(old_parts[2]), Verdict::kKnown) << "overtaken: it is never completed";
  EXPECT_EQ(assembler.Add(new_parts[1]), Verdict::kKnown);
  EXPECT_EQ(assembler.Add(new_parts[0]), Verdict::kTaken);
  EXPECT_EQ(assembler.Add(new_parts[2]), Verdict::kComplete);
  EXPECT_TRUE(Same(assembler.Take(), new_bytes));
  EXPECT_EQ(assembler.Add(new_parts[0]), Verdict::kKnown) << "delivered again";
  EXPECT_EQ(assembler.Add(old_parts[0]), Verdict::kKnown);
}

TEST(WeightsParts, ANewerLearnerSessionWinsWhateverItsUpdate) {
  const std::vector<uint8_t> bytes = Bytes(10, 1);
  WeightsAssembler assembler;
  EXPECT_EQ(assembler.Add(Parts(Weights(1, 500, bytes))[0]), Verdict::kComplete);
  EXPECT_EQ(assembler.Add(Parts(Weights(2, 400, bytes))[0]), Verdict::kComplete);
  EXPECT_EQ(assembler.Add(Parts(Weights(1, 501, bytes))[0]), Verdict::kKnown);
}

TEST(WeightsParts, WhatCannotBeIsRefused) {
  const std::vector<uint8_t> bytes = Bytes(2 * kBulkPartBytes + 9, 1);
  const std::vector<WeightsPart> parts = Parts(Weights(1, 1, bytes));
  const auto verdict = [&](auto change) {
    WeightsAssembler assembler;
    WeightsPart part = parts[1];
    change(part);
    return assembler.Add(part);
  };
  EXPECT_EQ(verdict([](WeightsPart&) {}), Verdict::kTaken);
  EXPECT_EQ(verdict([](WeightsPart& p) { ++p.crc; }), Verdict::kRefused);
  EXPECT_EQ(verdict([](WeightsPart& p) { p.part = 3; }), Verdict::kRefused);
  EXPECT_EQ(verdict([](WeightsPart& p) { p.part = 2; }), Verdict::kRefused) << "it has 9 bytes";
  EXPECT_EQ(verdict([](WeightsPart& p) { p.total_bytes = kMaxWeightsBytes + 1; }),
            Verdict::kRefused);
  EXPECT_EQ(verdict([](WeightsPart& p) {
              p.payload = p.payload.subspan(1);
              p.crc = Crc32(p.payload);
            }),
            Verdict::kRefused);
  WeightsAssembler assembler;
  EXPECT_EQ(assembler.Add(parts[0]), Verdict::kTaken);
  WeightsPart longer = parts[1];
  longer.total_bytes += 1;
  EXPECT_EQ(assembler.Add(longer), Verdict::kRefused) << "another size than its version has";
}

}  // namespace
}  // namespace shoal
