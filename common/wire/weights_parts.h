// SPDX-License-Identifier: Apache-2.0
// Weights travel in parts, so that no sample is larger than the transport carries well, whatever
// the size of the policy: part k holds the bytes from k * kBulkPartBytes on. A version is
// complete when all its parts are there; what is incomplete when a newer one begins is dropped.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/wire/messages.h"

namespace shoal {

// A receiver reserves as much at the word of one part.
inline constexpr uint64_t kMaxWeightsBytes = 1'000'000'000;

inline uint64_t WeightsParts(uint64_t total_bytes) {
  return (total_bytes + kBulkPartBytes - 1) / kBulkPartBytes;
}

// Part `part` of the weights, Part being WeightsPart or EvalWeightsPart. Its payload is a piece of
// theirs. CHECKs that there is such a part.
template <class Part>
Part PartOf(const WeightsMessage& weights, uint32_t part);

// Puts the newest version together. Owns its memory. One thread at a time.
class WeightsAssembler {
 public:
  enum class Verdict {
    kTaken,     // parts are still missing
    kComplete,  // it was the last one: Take() the version
    kKnown,     // of a version that is complete, or older than the newest, or that part again
    kRefused,   // damaged, or a part that cannot be
  };
  Verdict Add(const WeightsPart& part);

  // Moves the bytes of the complete version out; once.
  std::string Take() { return std::move(bytes_); }

 private:
  WeightsVersion version_;  // complete or being put together
  std::string bytes_;
  std::vector<bool> there_;  // by part
  uint64_t missing_ = 0;     // parts
};

extern template WeightsPart PartOf<WeightsPart>(const WeightsMessage&, uint32_t);
extern template EvalWeightsPart PartOf<EvalWeightsPart>(const WeightsMessage&, uint32_t);

}  // namespace shoal
