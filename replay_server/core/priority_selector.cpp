// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/priority_selector.h"

#include <algorithm>

namespace shoal::replay {

PrioritySelector::PrioritySelector(const Ring& ring, const EpisodeIndex& index,
                                   const PriorityScale& scale)
    : ring_(ring), index_(index), scale_(scale), weights_(static_cast<size_t>(ring.capacity())) {}

std::optional<Selection> PrioritySelector::Draw(Random* random) {
  if (weights_.total() == 0) return std::nullopt;
  const size_t slot = weights_.Find(random->Below(weights_.total()));
  return Selection{.id = IdIn(slot),
                   .probability = static_cast<double>(weights_.Get(slot)) /
                                  static_cast<double>(weights_.total())};
}

bool PrioritySelector::SetError(uint64_t id, float error) {
  if (!index_.Sampleable(id)) return false;
  const uint64_t weight = scale_.WeightOf(error);
  weights_.Set(Slot(id), weight);
  largest_ = std::max(largest_, weight);
  return true;
}

double PrioritySelector::largest_priority() const {
  return static_cast<double>(largest_) / static_cast<double>(PriorityScale::kOne);
}

// The ring contains the last `capacity` ids, one for each slot.
uint64_t PrioritySelector::IdIn(size_t slot) const {
  const uint64_t behind = (Slot(ring_.last_id()) + ring_.capacity() - slot) % ring_.capacity();
  return ring_.last_id() - behind;
}

}  // namespace shoal::replay
