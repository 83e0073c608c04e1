// SPDX-License-Identifier: Apache-2.0
// The networks of the agent in double, evaluated from named tensors.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "common/config/config.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/module.h"
#include "common/nn/safetensors.h"
#include "common/spec/observation_spec.h"
#include "tests/common/nn/reference.h"

namespace shoal::nn::reference {

using Parameters = std::map<std::string, Values>;

// The F32 tensors as Values; other tensors are ignored.
Parameters ToParameters(const TensorMap& tensors);

// Output of an encoder's plan for frames (B, K*C, H, W) u8. Batch normalisation normalises by the
// batch, or by running statistics.
Values Features(const NetworkPlan& encoder, const Parameters& parameters, int batch,
                const uint8_t* frames, Statistics statistics = Statistics::kBatch);

class Network {
 public:
  // Takes the F32 tensors; other tensors are ignored.
  Network(const TensorMap& tensors, const NetworkConfig& config, const ObservationSpec& spec);

  // One value of one parameter, for finite differences.
  double& at(const std::string& name, size_t index) { return parameters_.at(name).at(index); }
  const Parameters& parameters() const { return parameters_; }

  // Features of frames (B, K*C, H, W) u8: (B, N*h*w), N maps of (h, w).
  Values Features(int batch, const uint8_t* frames) const;
  // Input of the MLPs of `head`: the trunk's output for the features, joined with the vector (B,
  // V).
  Values Observation(const std::string& head, int batch, const Values& features,
                     const Values& vector) const;
  // Output of the MLP `name` (actor.mlp, critic.q1, ...) for input (B, I), I: its input size.
  Values Mlp(const std::string& name, int batch, const Values& input) const;
  // Residual blocks of an MLP, and the LayerNorm after them.
  Values Blocks(const std::string& name, int batch, Values x) const;
  struct Gaussian {
    Values mean, log_std;  // (B, A)
  };
  Gaussian Actor(int batch, const Values& features, const Values& vector) const;
  // Values (B) of head.qNUMBER for action (B, A). Numbers begin with 1.
  Values Q(const std::string& head, int number, int batch, const Values& features,
           const Values& vector, const Values& action) const;
  // Values (B) of head.q1 and head.q2 for action (B, A).
  struct TwinQ {
    Values q1, q2;
  };
  TwinQ Critic(const std::string& head, int batch, const Values& features, const Values& vector,
               const Values& action) const;

 private:
  const Values& P(const std::string& name) const { return parameters_.at(name); }

  NetworkConfig config_;
  ObservationSpec spec_;
  NetworkPlan encoder_;
  bool relu_trunk_;
  Parameters parameters_;
};

}  // namespace shoal::nn::reference
