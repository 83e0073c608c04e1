// SPDX-License-Identifier: Apache-2.0
// A latent model (latent_plan.h): joint features of state and action, and the predictions that are
// linear functions of these features. Unroll predicts several steps, each from the state predicted
// before it, and BackwardUnroll passes gradients back through all of them.
//
// Dimensions: B batch, Z numbers of the state, A actions, J joint features, R intervals of the
// reward, H steps.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "common/nn/array.h"
#include "common/nn/latent_plan.h"
#include "common/nn/module.h"

namespace shoal::nn {

// Computes on the CPU only. All results are valid until the next call of the function that returned
// them.
class LatentModelModule final : public Module {
 public:
  // `steps`: most steps H of Unroll; 0 for a module of Join alone.
  LatentModelModule(const LatentModelPlan& plan, int steps, Use use, const ModuleContext& context);
  ~LatentModelModule() override;

  void Refresh() override;

  // Joint features (B, J) of state (B, Z) and action (B, A).
  Array Join(Array state, Array action);
  // Computes only the gradient of the action (B, A) of the latest Join, from dL/djoint (B, J).
  // Needs Use::kTraining.
  void BackwardAction(Array joint_gradient, Array action_gradient);

  // Predictions for one step, or gradients of a loss by these predictions.
  struct Prediction {
    Array end, state, reward;  // (B), (B, Z), (B, R)
  };
  // Predicts the steps after `state` (B, Z) with the actions of the steps, (B, A) each.
  std::vector<Prediction> Unroll(Array state, std::span<const Array> actions);
  // Computes the gradients of the parameters for the latest Unroll, and writes dL/dstate (B, Z).
  // `gradients`: one for each step.
  void BackwardUnroll(std::span<const Prediction> gradients, Array state_gradient);

 private:
  struct Step;

  std::unique_ptr<Step> join_;                // of Join; else null
  std::vector<std::unique_ptr<Step>> steps_;  // of Unroll; they share the parameters
  std::vector<float> gradient_sums_;          // of the parameters, over the steps
};

}  // namespace shoal::nn
