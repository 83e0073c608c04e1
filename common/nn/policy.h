// The policy as an actor uses it: encoder, trunk and actor MLP, forward only.
#pragma once

#include <cstdint>
#include <memory>

#include "common/config/config.h"
#include "common/nn/precision.h"
#include "common/nn/safetensors.h"
#include "common/spec/observation_spec.h"

namespace shoal::nn {

class Policy {
 public:
  Policy(const NetworkConfig& network, const ObservationSpec& spec, Precision precision,
         int max_batch);
  ~Policy();

  // Takes F32 or BF16 tensors by name; throws Error naming a missing tensor or a wrong shape, and
  // then keeps its former weights.
  void Load(const TensorMap& tensors, const std::string& source);

  // frames (B, K*C, H, W) u8 (unread without pixels), vector (B, V) f32 (unread when V = 0).
  // mean, log_std (B, A): of the Gaussian before tanh. 0 < B <= max_batch.
  void Forward(int batch, const uint8_t* frames, const float* vector, float* mean, float* log_std);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shoal::nn
