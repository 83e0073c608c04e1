// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/critic_vectors.h"

#include <algorithm>
#include <string>

#include "common/config/privileged_blocks.h"

namespace shoal::learner {

ObservationSpec CriticSpec(const Config& config, const ObservationSpec& spec) {
  if (!config.sac.critic_blocks) return spec;
  ObservationSpec seen = spec;
  seen.cameras.clear();
  seen.channels = seen.height = seen.width = 0;
  seen.goal_picture = false;
  seen.blocks.clear();
  for (const BlockSpec& block : spec.blocks) {
    if (block.observed) seen.blocks.push_back(block);
  }
  for (const std::string& name : PrivilegedBlocksOf(config, spec).critic) {
    seen.blocks.push_back({name, spec.Recorded(name)->size, /*observed=*/true});
  }
  return seen;
}

CriticVectors::CriticVectors(const Config& config, const ObservationSpec& spec, Engine* engine)
    : engine_(engine) {
  const PrivilegedBlocks blocks = PrivilegedBlocksOf(config, spec);
  int first = 0, joined = spec.VectorSize();
  for (const std::string& name : blocks.all) {
    const int size = spec.Recorded(name)->size;
    if (std::ranges::count(blocks.critic, name) > 0) {
      columns_.push_back({first, size});
      joined += size;
    }
    first += size;
  }
  if (columns_.empty()) return;
  obs_ = engine->NewArray(joined);
  next_obs_ = engine->NewArray(joined);
}

CriticVectors::Vectors CriticVectors::Of(const Transitions& batch) {
  if (columns_.empty()) return {batch.obs_vector, batch.next_obs_vector};
  engine_->JoinColumns(batch.obs_vector, batch.obs_privileged, columns_, obs_);
  engine_->JoinColumns(batch.next_obs_vector, batch.next_obs_privileged, columns_, next_obs_);
  return {obs_, next_obs_};
}

}  // namespace shoal::learner
