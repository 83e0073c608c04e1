// Chooses which stored steps make up a batch. Uniform for now; prioritised sampling and hindsight
// relabelling are further implementations.
#pragma once

#include <cstdint>
#include <optional>

#include "common/base/random.h"

namespace shoal::replay {

class Sampler {
 public:
  virtual ~Sampler() = default;
  // The id of a sampleable step, or nothing when none was found. `random` alone decides, given the
  // same ring.
  virtual std::optional<uint64_t> Draw(Random* random) = 0;
  // Draws that had to be repeated since construction.
  virtual uint64_t redraws() const = 0;
};

}  // namespace shoal::replay
