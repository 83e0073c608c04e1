// SPDX-License-Identifier: Apache-2.0
// Weights are sent in parts, so that no sample exceeds the size that the transport carries well.
// Part k holds the bytes from k * kBulkPartBytes on. A version is complete when all its parts have
// arrived. If a part of a newer version arrives first, the incomplete version is dropped.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/wire/messages.h"

namespace shoal {

// Largest size of one version. The first part that arrives makes the receiver reserve the whole
// size.
inline constexpr uint64_t kMaxWeightsBytes = 1'000'000'000;

inline uint64_t WeightsParts(uint64_t total_bytes) {
  return (total_bytes + kBulkPartBytes - 1) / kBulkPartBytes;
}

// Part number `part` of the weights. The type Part is WeightsPart or EvalWeightsPart. The result's
// payload borrows a piece of the weights' payload. CHECKs that the part exists.
template <class Part>
Part PartOf(const WeightsMessage& weights, uint32_t part);

// Assembles the newest version from its parts. Owns its memory. One thread at a time.
class WeightsAssembler {
 public:
  enum class Verdict {
    kTaken,     // stored; other parts are still missing
    kComplete,  // stored; this part was the last one, so call Take()
    kKnown,     // ignored: the part arrived before, or its version is complete or not the newest
    kRefused,   // the part is damaged or inconsistent
  };
  Verdict Add(const WeightsPart& part);

  // Moves out the bytes of the complete version. Call it once.
  std::string Take() { return std::move(bytes_); }

 private:
  WeightsVersion version_;  // the complete version, or the one being assembled
  std::string bytes_;
  std::vector<bool> there_;  // by part: whether the part has arrived
  uint64_t missing_ = 0;     // number of missing parts
};

extern template WeightsPart PartOf<WeightsPart>(const WeightsMessage&, uint32_t);
extern template EvalWeightsPart PartOf<EvalWeightsPart>(const WeightsMessage&, uint32_t);

}  // namespace shoal
