// SPDX-License-Identifier: Apache-2.0
// Policies of every kind with random parameters.
#pragma once

#include <cmath>
#include <ostream>
#include <string>

#include "common/base/random.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/parameter_set.h"
#include "common/policy/checkpoint_policy.h"

namespace shoal::launch {

struct PolicyKind {
  std::string encoder;  // empty: vectors only
  nn::ActorOutput output = nn::ActorOutput::kGaussian;
  bool normalised = false;
};

// Used by googletest to print the parameter of a test.
inline void PrintTo(const PolicyKind& kind, std::ostream* out) {
  *out << '"' << kind.encoder << '"';
}

// A small spec. Sizes are odd if the encoder accepts odd sizes, so that alexnet's average pool has
// unequal windows.
inline ObservationSpec SpecFor(const std::string& encoder) {
  ObservationSpec spec;
  spec.task = "test";
  if (!encoder.empty()) {
    spec.cameras = {"front", "side"};
    spec.channels = 6;
    spec.stack = 2;
    spec.height = encoder == "alexnet" ? 63 : 48;
    spec.width = encoder == "alexnet" ? 127 : 44;
  }
  spec.blocks = {{"grip", 4}, {"unseen", 3, /*observed=*/false}, {"goal", 3}};
  spec.action_size = 3;
  return spec;
}

inline nn::NamedTensor FloatTensor(const std::vector<float>& values) {
  const auto* bytes = reinterpret_cast<const uint8_t*>(values.data());
  return {"F32", {int64_t(values.size())}, {bytes, bytes + values.size() * sizeof(float)}};
}

inline policy::CheckpointPolicy RandomPolicy(const PolicyKind& kind, NetworkConfig network = {}) {
  constexpr const char* kAlgorithms[] = {"sac", "td3", "ppo"};
  if (!kind.encoder.empty()) network.encoder = kind.encoder;
  network.initialisation = "pytorch";  // faster than orthogonal weights for large encoders
  network.hidden = {17, 12};
  if (network.blocks > 0) network.hidden.pop_back();
  policy::CheckpointPolicy policy;
  policy.description = {.version = "0.1.0",
                        .algorithm = kAlgorithms[int(kind.output)],
                        .output = kind.output,
                        .network = network,
                        .spec = SpecFor(kind.encoder)};
  std::vector<nn::ParameterSpec> specs = policy.description.Encoder().Parameters();
  nn::Append(policy.description.Actor().Parameters(), &specs);
  nn::ParameterSet set(specs, nn::ParameterSet::Use::kInference);
  set.Initialise(7);
  // Adds random numbers, because initial biases, norms and statistics have special values.
  // Variances stay positive.
  Random random(8);
  for (int64_t i = 0; i < set.size(); ++i) set.values()[i] += float(0.02 * random.Normal());
  set.Export(&policy.tensors);
  if (!kind.normalised) return policy;
  std::vector<float> mean, variance;
  for (int i = 0; i < policy.description.spec.VectorSize(); ++i) {
    mean.push_back(float(random.Normal()));
    variance.push_back(float(std::exp(random.Normal())));
  }
  policy.tensors[nn::kObservationMean] = FloatTensor(mean);
  policy.tensors[nn::kObservationVariance] = FloatTensor(variance);
  return policy;
}

}  // namespace shoal::launch
