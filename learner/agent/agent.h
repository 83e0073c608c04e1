// SPDX-License-Identifier: Apache-2.0
// Interface of an algorithm to the learner's loop. It hides networks, targets and optimisers behind
// one update of a batch. Loop, checkpoints, weights, reports and guards use algorithms only through
// this interface.
//
// An agent does not depend on DDS, clocks or files. Each algorithm has its own folder
// (learner/agent/ALGORITHM) and computes with an Engine; algorithms.h lists the algorithms.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "common/base/check.h"
#include "common/nn/pending_tensors.h"
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
  // False if the batch, a loss or a gradient is not finite. The agent then is as it was before the
  // update; updates that were in flight behind it had no effect and have no outcome.
  bool finite = true;
  // Errors max_i |Q_i - y| (B) of the batch's rows; empty without prioritised sampling.
  std::vector<float> errors{};
};

// One thread.
class Agent {
 public:
  virtual ~Agent() = default;

  // Performs one update and waits for its outcome. No other update may be in flight.
  UpdateOutcome Update(
      const BatchView& batch, const OnStageEnd& on_stage_end = [](UpdateStage) {}) {
    std::vector<UpdateOutcome> outcomes = Submit(batch, on_stage_end);
    std::ranges::move(Finish(), std::back_inserter(outcomes));
    CHECK(outcomes.size() == 1) << outcomes.size();
    return std::move(outcomes.front());
  }

  // Performs one update, or begins it: an agent may have several updates in flight, whose outcomes
  // are not known yet. Returns the outcomes that have become known, in the order of updates. An
  // update depends only on the agent's state and the batch: random draws of update u come from the
  // stream (seed, kLearnerUpdate, u). CHECKs the batch's size. Borrows the batch for the call.
  virtual std::vector<UpdateOutcome> Submit(const BatchView& batch,
                                            const OnStageEnd& on_stage_end) = 0;
  // Waits for all updates in flight and returns their outcomes. Required before the functions below
  // that read or write tensors, except CopyPolicyTensors.
  virtual std::vector<UpdateOutcome> Finish() { return {}; }
  // Number of updates done or in flight, including those before a checkpoint.
  virtual uint64_t updates() const = 0;

  // F32 parameters that an actor needs, with the names that nn::Policy::Load reads.
  virtual nn::TensorMap PolicyTensors() const = 0;
  // Begins a copy of these parameters as the updates submitted so far leave them, also if some are
  // in flight. Updates submitted later do not change the copy and do not wait for it. If an update
  // before the copy is not finite, the copy must not be used. The default waits for the copy.
  virtual nn::PendingTensors CopyPolicyTensors() const {
    return nn::PendingTensors(PolicyTensors());
  }
  // PolicyTensors, averaged over the latest updates: the policy that is evaluated and stored in
  // checkpoints.
  virtual nn::TensorMap AveragedPolicyTensors() const = 0;
  // Everything an exact resume needs: parameters, targets, averages, optimisers, counters.
  virtual nn::TensorMap AllTensors() const = 0;
  // Restores the result of AllTensors. Throws Error naming a missing tensor or a wrong shape; the
  // agent is then unchanged.
  virtual void Restore(const nn::TensorMap& tensors, const std::string& source) = 0;
};

}  // namespace shoal::learner
