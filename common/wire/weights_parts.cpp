// SPDX-License-Identifier: Apache-2.0
#include "common/wire/weights_parts.h"

#include <algorithm>
#include <cstring>

#include "common/base/check.h"
#include "common/base/crc32.h"

namespace shoal {
namespace {

uint64_t SizeOfPart(uint64_t total_bytes, uint32_t part) {
  return std::min(kBulkPartBytes, total_bytes - part * kBulkPartBytes);
}

// Whether a sender could make this part, and its bytes are those that were sent.
bool Whole(const WeightsPart& part) {
  return part.total_bytes > 0 && part.total_bytes <= kMaxWeightsBytes &&
         part.part < WeightsParts(part.total_bytes) &&
         part.payload.size() == SizeOfPart(part.total_bytes, part.part) &&
         Crc32(part.payload) == part.crc;
}

}  // namespace

template <class Part>
Part PartOf(const WeightsMessage& weights, uint32_t part) {
  const uint64_t total_bytes = weights.payload.size();
  CHECK(part < WeightsParts(total_bytes)) << part << " of " << total_bytes << " bytes";
  Part message;
  message.part = part;
  message.spec_hash = weights.spec_hash;
  message.version = weights.version;
  message.env_steps = weights.env_steps;
  message.total_bytes = total_bytes;
  message.checkpoint = weights.checkpoint;
  message.payload = weights.payload.subspan(part * kBulkPartBytes, SizeOfPart(total_bytes, part));
  message.crc = Crc32(message.payload);
  return message;
}

template WeightsPart PartOf<WeightsPart>(const WeightsMessage&, uint32_t);
template EvalWeightsPart PartOf<EvalWeightsPart>(const WeightsMessage&, uint32_t);

WeightsAssembler::Verdict WeightsAssembler::Add(const WeightsPart& part) {
  if (!Whole(part)) return Verdict::kRefused;
  if (version_.NewerThan(part.version)) return Verdict::kKnown;
  if (part.version.NewerThan(version_)) {
    version_ = part.version;
    missing_ = WeightsParts(part.total_bytes);
    there_.assign(missing_, false);
    bytes_.resize(part.total_bytes);
  }
  if (missing_ == 0) return Verdict::kKnown;
  // The size differs from that of the version's first part.
  if (part.total_bytes != bytes_.size()) return Verdict::kRefused;
  if (there_[part.part]) return Verdict::kKnown;
  there_[part.part] = true;
  std::memcpy(bytes_.data() + part.part * kBulkPartBytes, part.payload.data(), part.payload.size());
  return --missing_ == 0 ? Verdict::kComplete : Verdict::kTaken;
}

}  // namespace shoal
