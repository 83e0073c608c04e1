// SPDX-License-Identifier: Apache-2.0
// The policy for acting: the forward pass of encoder, trunk and actor MLP, and the action without
// exploration. The actor process adds exploration.
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
  // False if actions are clipped instead of squashed by tanh.
  bool squashed = true;
};

// Computes the actions without exploration, (B, A) in [-1, 1]: tanh(mean), or clip(mean, -1, 1) for
// a policy that is not squashed. CHECKs that `actions` has the size of the mean.
void MeanActions(const PolicyOutput& output, std::span<float> actions);

// Determines the kind of a policy from its tensors. A policy with a parameter for the log deviation
// is unsquashed. Otherwise, a policy whose last layer has A outputs is deterministic. This function
// does not check the tensors; Policy::Load refuses missing and misshaped tensors.
ActorOutput ActorOutputOf(const TensorViews& tensors, int action_size);

class Policy {
 public:
  Policy(const NetworkConfig& network, const ObservationSpec& spec, Precision precision,
         int max_batch);
  ~Policy();

  // Loads F32 or BF16 tensors by name; the tensors determine the kind of policy (ActorOutputOf). If
  // they include kObservationMean and kObservationVariance (actor_critic_plan.h), Forward
  // normalises the vectors first. The policy keeps the tensors until the next load. Matrices and
  // filters are copied only into the layouts that the CPU's primitives read. Throws Error that
  // names a missing tensor or a wrong shape; the policy then keeps its former weights.
  void Load(TensorMap tensors, const std::string& source);
  // Does the same for the bytes of a safetensors file, which are shared and not copied.
  void Load(const SharedBytes& file, const std::string& source);

  // frames: B stacks of K frames (C, H, W), (B, K*C, H, W) u8; not read without pixels. vector:
  // (B, V) f32; not read if V = 0. B = `batch`, 0 < B <= max_batch. The result is valid until the
  // next call.
  PolicyOutput Forward(int batch, const uint8_t* frames, const float* vector);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shoal::nn
