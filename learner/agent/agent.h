// SPDX-License-Identifier: Apache-2.0
// An algorithm as the learner's loop sees it: networks, targets and optimisers behind one update of
// a batch. Loop, checkpoints, weights, reports and guards know no algorithm but through this.
//
// An agent knows nothing of DDS, clocks or files. Each lives in a folder of its own
// (learner/agent/ALGORITHM), written against common/nn; algorithms.h lists them.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "common/nn/safetensors.h"
#include "common/wire/batch_schema.h"
#include "learner/agent/update_figures.h"

namespace shoal::learner {

// What the time of an update goes into. Optimiser: and what follows it, targets and averages.
enum class UpdateStage { kForward, kBackward, kOptimiser };

// Told whenever a stage ends: the time since the last call, or since the update's beginning, went
// into it. A stage may end several times in one update.
using OnStageEnd = std::function<void(UpdateStage)>;

struct UpdateOutcome {
  // Figures that an update does not compute (the actor's, where it leaves the actor alone) are
  // absent.
  UpdateFigures figures;
  // False: the batch, a loss or a gradient is not finite; nothing has changed.
  bool finite = true;
};

// One thread.
class Agent {
 public:
  virtual ~Agent() = default;

  UpdateOutcome Update(const BatchView& batch) {
    return Update(batch, [](UpdateStage) {});
  }
  // Depends on the agent's state and the batch alone: random draws of update u come from the stream
  // (seed, kLearnerUpdate, u). CHECKs the batch's size.
  virtual UpdateOutcome Update(const BatchView& batch, const OnStageEnd& on_stage_end) = 0;
  // Done so far, those before a checkpoint included.
  virtual uint64_t updates() const = 0;

  // F32 parameters an actor needs (names as nn::Policy loads them).
  virtual nn::TensorMap PolicyTensors() const = 0;
  // The same, averaged over the latest updates: what is evaluated and kept as a checkpoint's
  // policy.
  virtual nn::TensorMap AveragedPolicyTensors() const = 0;
  // Everything an exact resume needs: parameters, targets, averages, optimisers, counters.
  virtual nn::TensorMap AllTensors() const = 0;
  // Takes what AllTensors gave. Throws Error naming a missing tensor or a wrong shape; then nothing
  // has changed.
  virtual void Restore(const nn::TensorMap& tensors, const std::string& source) = 0;
};

}  // namespace shoal::learner
