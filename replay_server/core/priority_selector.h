// SPDX-License-Identifier: Apache-2.0
// Prioritised sampling (Eq. 33 of docs/algorithm.md): a sample is drawn with probability
//
//   P(i) = weight_i / sum of the weights of all samples
//
// A new sample has the largest weight that any sample has had so far, so that it is drawn soon.
// SetError replaces this weight when the learner has used the sample. Weights are in memory only: a
// restarted server gives every sample of its ring the first weight.
#pragma once

#include <cstdint>
#include <optional>

#include "replay_server/core/episode_index.h"
#include "replay_server/core/priority_scale.h"
#include "replay_server/core/ring.h"
#include "replay_server/core/selector.h"
#include "replay_server/core/weight_tree.h"

namespace shoal::replay {

class PrioritySelector final : public Selector {
 public:
  // Borrows ring and index.
  PrioritySelector(const Ring& ring, const EpisodeIndex& index, const PriorityScale& scale);

  // Bytes of memory for a ring of `capacity` records.
  static constexpr uint64_t Bytes(uint64_t capacity) { return WeightTree::Bytes(capacity); }

  void Added(uint64_t id) override { weights_.Set(Slot(id), largest_); }
  void Removed(uint64_t id) override { weights_.Set(Slot(id), 0); }
  std::optional<Selection> Draw(Random* random) override;
  bool SetError(uint64_t id, float error) override;
  // The largest p^a so far, at first 1.
  double largest_priority() const override;
  uint64_t redraws() const override { return 0; }

 private:
  size_t Slot(uint64_t id) const { return static_cast<size_t>(id % ring_.capacity()); }
  // The id of the record in a slot.
  uint64_t IdIn(size_t slot) const;

  const Ring& ring_;
  const EpisodeIndex& index_;
  const PriorityScale scale_;
  WeightTree weights_;  // by slot; 0 = cannot be drawn
  uint64_t largest_ = PriorityScale::kOne;
};

}  // namespace shoal::replay
