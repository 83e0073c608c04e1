// SPDX-License-Identifier: Apache-2.0
// Input vectors of a critic: the vectors of the policy and, for an asymmetric critic
// (sac.critic_blocks), privileged blocks.
//
//   obs[b] = [ obs_vector[b] | critic's columns of obs_privileged[b] ],   (B, C)
//
// Dimensions: B batch, C size of the critic's vector.
#pragma once

#include <vector>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

// Returns the observation spec of a critic's networks. This is `spec` or, for an asymmetric critic,
// a spec without pixels whose vector (C) ends with the privileged blocks.
ObservationSpec CriticSpec(const Config& config, const ObservationSpec& spec);

// Only one thread may use an object.
class CriticVectors {
 public:
  // Borrows the engine.
  CriticVectors(const Config& config, const ObservationSpec& spec, Engine* engine);

  // Arrays (B, C). If no privileged block is added, they are the batch's own arrays. Otherwise,
  // they are valid until the next call.
  struct Vectors {
    Array obs, next_obs;
  };
  Vectors Of(const Transitions& batch);

 private:
  Engine* const engine_;
  std::vector<ObservationSpec::Range> columns_;  // columns of the privileged vector
  Array obs_, next_obs_;                         // (B, C); empty if no block is added
};

}  // namespace shoal::learner
