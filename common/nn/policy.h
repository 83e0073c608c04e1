// SPDX-License-Identifier: Apache-2.0
// The policy for acting: encoder, trunk and actor MLP, forward only, and the action without
// exploration. Exploration is the task of the actor process.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "common/base/shared_bytes.h"
#include "common/config/config.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/precision.h"
#include "common/nn/safetensors.h"
#include "common/spec/observation_spec.h"

namespace shoal::nn {

// Output for a batch of B observations with A actions each, (B, A).
struct PolicyOutput {
  std::span<const float> mean;     // before tanh
  std::span<const float> log_std;  // log deviation; empty for a deterministic policy
  // False: an action is not squashed by tanh, but clipped.
  bool squashed = true;
};

// Computes the actions without exploration, (B, A) in [-1, 1]: tanh(mean), or clip(mean, -1, 1) for
// a policy that is not squashed. CHECKs that `actions` has the size of the mean.
void MeanActions(const PolicyOutput& output, std::span<float> actions);

// Returns the kind of a policy from its tensors. A policy with a parameter for the log deviation is
// unsquashed; a policy whose last layer has A outputs is deterministic. Load refuses missing and
// misshaped tensors.
ActorOutput ActorOutputOf(const TensorViews& tensors, int action_size);

class Policy {
 public:
  Policy(const NetworkConfig& network, const ObservationSpec& spec, Precision precision,
         int max_batch);
  ~Policy();

  // Loads F32 or BF16 tensors by name; the tensors determine the kind of policy (ActorOutputOf). If
  // they include kObservationMean and kObservationVariance (actor_critic_plan.h), Forward
  // normalises the vectors first. The policy keeps the tensors until the next load, and copies
  // matrices and filters only into the layouts of the CPU. Throws Error that names a missing tensor
  // or a wrong shape; the policy then keeps its former weights.
  void Load(TensorMap tensors, const std::string& source);
  // The same for the bytes of a safetensors file, which are shared and not copied.
  void Load(const SharedBytes& file, const std::string& source);

  // frames (B, K*C, H, W) u8 (unread without pixels), vector (B, V) f32 (unread when V = 0).
  // 0 < B <= max_batch. The result is valid until the next call.
  PolicyOutput Forward(int batch, const uint8_t* frames, const float* vector);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shoal::nn
