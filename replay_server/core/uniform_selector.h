// SPDX-License-Identifier: Apache-2.0
// Draws every sample with the same probability.
#pragma once

#include "replay_server/core/episode_index.h"
#include "replay_server/core/ring.h"
#include "replay_server/core/selector.h"

namespace shoal::replay {

// Draws ids of the whole ring until an id is sampleable. The episode index has this information, so
// the selector keeps no list. Few records are not sampleable (resets, and steps whose frames are
// overwritten), so almost every first draw succeeds. Borrows ring and index, which must have the
// same owner as the selector.
class UniformSelector final : public Selector {
 public:
  // If one step in a thousand is sampleable, the search fails with probability e^-100.
  static constexpr int kMaxDraws = 100'000;

  UniformSelector(const Ring& ring, const EpisodeIndex& index) : ring_(ring), index_(index) {}

  void Added(uint64_t) override {}
  void Removed(uint64_t) override {}
  std::optional<Selection> Draw(Random* random) override;
  uint64_t redraws() const override { return redraws_; }

 private:
  const Ring& ring_;
  const EpisodeIndex& index_;
  uint64_t redraws_ = 0;
};

}  // namespace shoal::replay
