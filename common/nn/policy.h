// SPDX-License-Identifier: Apache-2.0
// The policy as an actor uses it: encoder, trunk and actor MLP, forward only, and the action
// without exploration. What exploration makes of the output is the actor's.
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
  std::span<const float> log_std;  // of the Gaussian around it; empty of a deterministic policy
  // False: an action is not squashed by tanh, but clipped.
  bool squashed = true;
};

// The actions of no exploration, (B, A) in [-1, 1]: tanh(mean), or clip(mean, -1, 1) of a policy
// that is not squashed. CHECK that there are as many as means.
void MeanActions(const PolicyOutput& output, std::span<float> actions);

// The kind of a policy, read off its tensors: a policy with a log deviation of its own is
// unsquashed, a policy whose last layer has A outputs is deterministic. Load refuses missing and
// misshaped tensors.
ActorOutput ActorOutputOf(const TensorViews& tensors, int action_size);

class Policy {
 public:
  Policy(const NetworkConfig& network, const ObservationSpec& spec, Precision precision,
         int max_batch);
  ~Policy();

  // Takes F32 or BF16 tensors by name; they say what kind of policy they are (ActorOutputOf).
  // Vectors are normalised first where there are kObservationMean and kObservationVariance
  // (actor_critic_plan.h). Keeps the tensors until the next ones: matrices and filters are not
  // copied but into the layouts of the CPU. Throws Error naming a missing tensor or a wrong shape,
  // and then keeps its former weights.
  void Load(TensorMap tensors, const std::string& source);
  // The same of a safetensors file's bytes, which are shared and not copied.
  void Load(const SharedBytes& file, const std::string& source);

  // frames (B, K*C, H, W) u8 (unread without pixels), vector (B, V) f32 (unread when V = 0).
  // 0 < B <= max_batch. The result is valid until the next call.
  PolicyOutput Forward(int batch, const uint8_t* frames, const float* vector);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shoal::nn
