// Every sampleable step with the same probability.
#pragma once

#include "replay_server/core/episode_index.h"
#include "replay_server/core/ring.h"
#include "replay_server/core/sampler.h"

namespace shoal::replay {

// Draws ids of the whole ring until one is sampleable. Resets and steps whose frames are
// overwritten are few, so almost every first draw counts. Borrows both; same owner.
class UniformSampler : public Sampler {
 public:
  // With only one step in a thousand sampleable, giving up wrongly has probability e^-100.
  static constexpr int kMaxDraws = 100'000;

  UniformSampler(const Ring& ring, const EpisodeIndex& index) : ring_(ring), index_(index) {}

  std::optional<uint64_t> Draw(Random* random) override;
  uint64_t redraws() const override { return redraws_; }

 private:
  const Ring& ring_;
  const EpisodeIndex& index_;
  uint64_t redraws_ = 0;
};

}  // namespace shoal::replay
