// SPDX-License-Identifier: Apache-2.0
// Weights are sent in parts, because the transport is slow for large samples. Part k contains the
// bytes from offset k * kBulkPartBytes. A version is complete when all its parts have arrived. If a
// part of a newer version arrives before, the incomplete version is dropped.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/wire/messages.h"

namespace shoal {

// Largest size of one version in bytes. When the first part of a version arrives, the receiver
// reserves memory for all its parts.
inline constexpr uint64_t kMaxWeightsBytes = 1'000'000'000;

inline uint64_t WeightsParts(uint64_t total_bytes) {
  return (total_bytes + kBulkPartBytes - 1) / kBulkPartBytes;
}

// Part number `part` of the weights. The type Part is WeightsPart or EvalWeightsPart. The result's
// payload borrows a piece of the weights' payload. CHECKs that the part exists.
template <class Part>
Part PartOf(const WeightsMessage& weights, uint32_t part);

// Assembles the newest version from its parts. Owns its memory. Only one thread at a time may use
// an object.
class WeightsAssembler {
 public:
  enum class Verdict {
    kTaken,     // stored; other parts are still missing
    kComplete,  // stored; this part was the last one, so call Take()
    kKnown,     // ignored: the part arrived before, or its version is complete or is not the newest
    kRefused,   // the part is damaged or inconsistent
  };
  Verdict Add(const WeightsPart& part);

  // Moves out the bytes of the complete version. Call it once.
  std::string Take() { return std::move(bytes_); }

 private:
  WeightsVersion version_;  // version that is complete or that is being assembled
  std::string bytes_;
  std::vector<bool> there_;  // by part: whether the part has arrived
  uint64_t missing_ = 0;     // number of missing parts
};

extern template WeightsPart PartOf<WeightsPart>(const WeightsMessage&, uint32_t);
extern template EvalWeightsPart PartOf<EvalWeightsPart>(const WeightsMessage&, uint32_t);

}  // namespace shoal
