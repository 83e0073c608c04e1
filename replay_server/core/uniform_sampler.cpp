#include "replay_server/core/uniform_sampler.h"

namespace shoal::replay {

std::optional<uint64_t> UniformSampler::Draw(Random* random) {
  if (index_.sampleable() == 0) return std::nullopt;
  const uint64_t records = ring_.last_id() - ring_.oldest_id() + 1;
  for (int i = 0; i < kMaxDraws; ++i) {
    const uint64_t id = ring_.oldest_id() + random->Below(records);
    if (index_.Sampleable(id)) return id;
    ++redraws_;
  }
  return std::nullopt;
}

}  // namespace shoal::replay
