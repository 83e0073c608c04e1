// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/encoder_start.h"

#include "common/base/check.h"

namespace shoal::learner {

void StartEncoder(const nn::TensorMap& weights, Agent* agent) {
  CHECK(agent->updates() == 0) << agent->updates() << " updates";
  nn::TensorMap tensors = agent->AllTensors();
  for (const auto& [name, weight] : weights) {
    CHECK(tensors.contains(name)) << name;
    for (auto& [own, tensor] : tensors) {
      const bool copy = own.ends_with("." + name) && !own.starts_with("adam.");
      if (own == name || copy) tensor = weight;
    }
  }
  agent->Restore(tensors, "the encoder's weights");
}

}  // namespace shoal::learner
