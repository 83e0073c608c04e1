// SPDX-License-Identifier: Apache-2.0
// Interface of an algorithm to the learner's loop. It hides networks, targets and optimisers behind
// one update of a batch. Loop, checkpoints, weights, reports and guards use algorithms only through
// this interface.
//
// An agent does not depend on DDS, clocks or files. Each algorithm has its own folder
// (learner/agent/ALGORITHM) and computes with an Engine; algorithms.h lists the algorithms.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "common/nn/safetensors.h"
#include "common/wire/batch_schema.h"
#include "learner/agent/update_figures.h"

namespace shoal::learner {

// Stages of an update, for time measurements. kOptimiser includes the targets and averages that
// follow the step.
enum class UpdateStage { kForward, kBackward, kOptimiser };

// Called whenever a stage ends. The time since the last call, or since the update's beginning,
// belongs to that stage. A stage may end several times in one update.
using OnStageEnd = std::function<void(UpdateStage)>;

struct UpdateOutcome {
  // Figures that an update does not compute are absent (for example, the actor's figures if the
  // update does not train the actor).
  UpdateFigures figures;
  // False if the batch, a loss or a gradient is not finite; the agent is then unchanged.
  bool finite = true;
};

// One thread.
class Agent {
 public:
  virtual ~Agent() = default;

  UpdateOutcome Update(const BatchView& batch) {
    return Update(batch, [](UpdateStage) {});
  }
  // Performs one update. It depends only on the agent's state and the batch: random draws of update
  // u come from the stream (seed, kLearnerUpdate, u). CHECKs the batch's size.
  virtual UpdateOutcome Update(const BatchView& batch, const OnStageEnd& on_stage_end) = 0;
  // Number of updates done, including those before a checkpoint.
  virtual uint64_t updates() const = 0;

  // F32 parameters that an actor needs, with the names that nn::Policy::Load reads.
  virtual nn::TensorMap PolicyTensors() const = 0;
  // The same, averaged over the latest updates: the policy that is evaluated and stored in
  // checkpoints.
  virtual nn::TensorMap AveragedPolicyTensors() const = 0;
  // Everything an exact resume needs: parameters, targets, averages, optimisers, counters.
  virtual nn::TensorMap AllTensors() const = 0;
  // Restores the result of AllTensors. Throws Error naming a missing tensor or a wrong shape; the
  // agent is then unchanged.
  virtual void Restore(const nn::TensorMap& tensors, const std::string& source) = 0;
};

}  // namespace shoal::learner
