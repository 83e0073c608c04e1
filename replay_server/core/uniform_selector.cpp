// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/uniform_selector.h"

namespace shoal::replay {

std::optional<Selection> UniformSelector::Draw(Random* random) {
  if (index_.sampleable() == 0) return std::nullopt;
  const uint64_t records = ring_.last_id() - ring_.oldest_id() + 1;
  for (int i = 0; i < kMaxDraws; ++i) {
    const uint64_t id = ring_.oldest_id() + random->Below(records);
    if (index_.Sampleable(id)) return Selection{id, 1.0 / static_cast<double>(index_.sampleable())};
    ++redraws_;
  }
  return std::nullopt;
}

}  // namespace shoal::replay
