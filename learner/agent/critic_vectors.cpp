// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/critic_vectors.h"

#include <algorithm>
#include <span>

#include "common/config/privileged_blocks.h"

namespace shoal::learner {

ObservationSpec CriticSpec(const LearnerConfig& learner, const ObservationSpec& spec) {
  if (!learner.critic_blocks) return spec;
  ObservationSpec seen = spec;
  seen.cameras.clear();
  seen.channels = seen.height = seen.width = 0;
  seen.goal_picture = false;
  seen.blocks.clear();
  for (const BlockSpec& block : spec.blocks) {
    if (block.observed) seen.blocks.push_back(block);
  }
  for (const std::string& name : PrivilegedBlocksOf(learner, spec).critic) {
    seen.blocks.push_back({name, spec.Recorded(name)->size, /*observed=*/true});
  }
  return seen;
}

CriticVectors::CriticVectors(const LearnerConfig& learner, const ObservationSpec& spec)
    : vector_size_(spec.VectorSize()) {
  const PrivilegedBlocks blocks = PrivilegedBlocksOf(learner, spec);
  for (const std::string& name : blocks.all) {
    const int size = spec.Recorded(name)->size;
    if (std::ranges::count(blocks.critic, name) > 0) columns_.push_back({privileged_size_, size});
    privileged_size_ += size;
  }
}

CriticVectors::Vectors CriticVectors::Of(const BatchView& batch) {
  if (columns_.empty()) return {batch.obs_vector.data(), batch.next_obs_vector.data()};
  Join(batch.obs_vector, batch.obs_privileged, &obs_);
  Join(batch.next_obs_vector, batch.next_obs_privileged, &next_obs_);
  return {obs_.data(), next_obs_.data()};
}

void CriticVectors::Join(std::span<const float> observed, std::span<const float> privileged,
                         std::vector<float>* joined) const {
  joined->clear();
  const size_t rows = privileged.size() / size_t(privileged_size_);
  for (size_t b = 0; b < rows; ++b) {
    const auto own = observed.subspan(b * size_t(vector_size_), size_t(vector_size_));
    joined->insert(joined->end(), own.begin(), own.end());
    for (const auto& [first, size] : columns_) {
      const auto part =
          privileged.subspan(b * size_t(privileged_size_) + size_t(first), size_t(size));
      joined->insert(joined->end(), part.begin(), part.end());
    }
  }
}

}  // namespace shoal::learner
