// SPDX-License-Identifier: Apache-2.0
// Weights of a policy whose output does not depend on its input.
#pragma once

#include <cstring>
#include <string>

#include "actor/acting/weights_inbox.h"
#include "common/config/config.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/safetensors.h"
#include "common/spec/observation_spec.h"

namespace shoal::actor {

// All parameters are zero except the biases of the last layer: `mean` and `raw_log_std` (the number
// before the tanh of Eq. 4) for each action component.
inline ReceivedWeights ConstantPolicy(const NetworkConfig& network, const ObservationSpec& spec,
                                      WeightsVersion version, float mean, float raw_log_std,
                                      uint64_t env_steps = 0) {
  nn::TensorMap tensors;
  for (const nn::ParameterSpec& parameter : nn::PolicyParameters(network, spec)) {
    int64_t count = 1;
    for (const int64_t size : parameter.shape) count *= size;
    std::vector<float> values(static_cast<size_t>(count), 0.0F);
    if (parameter.name == "actor.mlp.output.bias") {
      std::fill(values.begin(), values.begin() + count / 2, mean);
      std::fill(values.begin() + count / 2, values.end(), raw_log_std);
    }
    std::vector<uint8_t> bytes(values.size() * 4);
    std::memcpy(bytes.data(), values.data(), bytes.size());
    tensors[parameter.name] = {"F32", parameter.shape, std::move(bytes)};
  }
  return {version, env_steps, "", nn::WriteSafetensors(tensors, {})};
}

}  // namespace shoal::actor
