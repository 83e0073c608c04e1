// SAC with DrQ: networks, targets, optimisers and one update. Knows nothing of DDS, threads, clocks
// or files. Equations are numbered in docs/algorithm.md.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/config/config.h"
#include "common/nn/precision.h"
#include "common/nn/safetensors.h"
#include "common/spec/observation_spec.h"
#include "common/wire/batch_layout.h"

namespace shoal::learner {

// Means over the batch of one update. Actor and temperature values are those of the last actor
// update.
struct UpdateStats {
  float critic_loss = 0, actor_loss = 0, temperature = 0, temperature_loss = 0;
  float q_mean = 0, target_mean = 0;
  float entropy = 0;            // -mean log pi
  float action_saturation = 0;  // share of sampled action components with |a| > 0.99
  float critic_grad_norm = 0, actor_grad_norm = 0;
  // Standard deviation of a frame's pixels, grey levels; mean over 32 frames.
  float frame_spread = 0;
  float frozen_cameras = 0;  // that show one picture throughout: agent/frozen_cameras.h
  bool finite = true;        // false: a loss or weight is not finite; the update was not applied
};

// Where the seconds of all updates went.
struct UpdateSeconds {
  double forward = 0;  // checks of the batch and losses too
  double backward = 0;
  double optimiser = 0;  // and what follows it: targets, averages
};

class SacAgent {
 public:
  // Initialises the networks from config.seed. Random draws of update u come from the stream
  // (seed, kLearnerUpdate, u), so an update depends on state and batch alone.
  SacAgent(const Config& config, const ObservationSpec& spec, nn::Precision precision);
  ~SacAgent();

  UpdateStats Update(const BatchView& batch);
  uint64_t updates() const;
  // Since the construction.
  const UpdateSeconds& seconds() const;

  // F32 parameters an actor needs (names as nn::Policy loads them).
  nn::TensorMap PolicyTensors() const;
  // The same, averaged over the latest updates: what is evaluated and kept as a checkpoint's
  // policy.
  nn::TensorMap AveragedPolicyTensors() const;
  // Everything an exact resume needs: parameters, targets, averages, Adam moments and steps, log
  // temperature, update counter.
  nn::TensorMap AllTensors() const;
  // Throws Error naming a missing tensor or a wrong shape; then nothing has changed.
  void Restore(const nn::TensorMap& tensors, const std::string& source);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shoal::learner
