// The networks of SAC, their targets and optimisers, behind plain arrays: what an algorithm needs
// and nothing of the engine that computes it.
//
//   encoder.*, critic.*    trained by the critic's loss, one optimiser
//   actor.*                trained by the actor's loss on the same features, detached
//   target.*               trunk and heads that follow critic.*; there is no target encoder
//   average.*              moving average of encoder.* and actor.*
//   temperature.log        one number
//
// Dimensions: B batch, A actions, V vector size, K*C channels. Arrays are row-major f32; a result
// is valid until the function that returned it is called again.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/config/config.h"
#include "common/nn/precision.h"
#include "common/nn/safetensors.h"
#include "common/spec/observation_spec.h"

namespace shoal::nn {

// Owns everything; built for one batch size. One thread at a time, always under a ThreadScope
// (parallel.h) of the size it was built in.
class ActorCritic {
 public:
  struct Options {
    int batch = 0;
    uint64_t seed = 0;  // of the initial parameters
    double learning_rate = 0;
    double initial_temperature = 0;
  };

  ActorCritic(const NetworkConfig& network, const ObservationSpec& spec, Precision precision,
              const Options& options);
  ~ActorCritic();

  // frames (B, K*C, H, W) u8. The features stay until the next call and are what every head below
  // sees. Without pixels it does nothing.
  void Encode(const uint8_t* frames);

  // vector (B, V) in all of these.
  struct Gaussian {
    const float *mean, *log_std;  // (B, A), before tanh
  };
  Gaussian ForwardActor(const float* vector);
  struct TwinQ {
    const float *q0, *q1;  // (B)
  };
  TwinQ ForwardTarget(const float* vector, const float* action);
  TwinQ ForwardCritic(const float* vector, const float* action);

  // Gradients of encoder and critic from dL/dq (B) of the latest ForwardCritic, which has to be of
  // the latest Encode. Returns the sum of their squares.
  double BackwardCritic(const float* q0_gradient, const float* q1_gradient);
  // dL/daction (B, A) of the latest ForwardCritic alone.
  void BackwardAction(const float* q0_gradient, const float* q1_gradient, float* action_gradient);
  // Gradients of the actor from dL/dmean, dL/dlog_std (B, A) of the latest ForwardActor. Returns
  // the sum of their squares.
  double BackwardActor(const float* mean_gradient, const float* log_std_gradient);

  // One optimiser step with the latest gradients. Features stay those of before.
  void StepCritic();
  // Takes the latest StepCritic back exactly.
  void UndoStepCritic();
  void StepActor();
  float Temperature() const;
  // Gradient of the log temperature.
  void StepTemperature(float gradient);
  // target += tau * (critic - target), trunk and heads.
  void MoveTarget(float tau);

  // average += rate * (policy - average), encoder and actor.
  void MovePolicyAverage(float rate);

  // encoder.* and actor.*, F32: the newest ones, and their moving average.
  TensorMap PolicyTensors() const;
  TensorMap AveragedPolicyTensors() const;
  // All parameters, optimiser moments and steps.
  TensorMap AllTensors() const;
  // Throws Error naming a missing tensor or a wrong shape; then nothing has changed.
  void Restore(const TensorMap& tensors, const std::string& source);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shoal::nn
