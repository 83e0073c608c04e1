// SPDX-License-Identifier: Apache-2.0
// Vectors of a batch that a critic sees: those of the policy and, for an asymmetric critic
// (sac.critic_blocks), privileged blocks beside them.
//
//   obs[b] = [ obs_vector[b] | critic's columns of obs_privileged[b] ],   (B, C)
#pragma once

#include <vector>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

// The spec that a critic's networks are planned by: `spec` or, of an asymmetric critic, one without
// pixels whose vector (C) has the privileged blocks at its end.
ObservationSpec CriticSpec(const Config& config, const ObservationSpec& spec);

// One thread.
class CriticVectors {
 public:
  // Borrows the engine.
  CriticVectors(const Config& config, const ObservationSpec& spec, Engine* engine);

  // (B, C); the batch's own arrays where nothing is added, else valid until the next call.
  struct Vectors {
    Array obs, next_obs;
  };
  Vectors Of(const Transitions& batch);

 private:
  Engine* const engine_;
  std::vector<ObservationSpec::Range> columns_;  // of the privileged vector
  Array obs_, next_obs_;                         // (B, C); none where nothing is added
};

}  // namespace shoal::learner
