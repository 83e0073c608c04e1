// SPDX-License-Identifier: Apache-2.0
// The auxiliary loss of sac.aux: linear functions of the trunk's outputs are to tell recorded
// blocks or differences of two, so that the encoder learns where things are before the critic
// knows what is worth anything (Eq. 27 of docs/algorithm.md). The policy has no part of it.
//
//   L = w / (B L) sum_(b,l) (y_(b,l) - label_(b,l) / 0.15)^2
//
// Labels are positions in m as a rule: 0.15 m is what they vary by.
//
// Dimensions: B batch, L labels.
#pragma once

#include <memory>
#include <vector>

#include "common/config/config.h"
#include "common/nn/readout_module.h"
#include "common/spec/observation_spec.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

// One thread.
class AuxLoss {
 public:
  // Null without sac.aux. Borrows the engine and `trunk`, of the head that trains the encoder.
  static std::unique_ptr<AuxLoss> Make(const Config& config, const ObservationSpec& spec,
                                       const nn::Features* trunk, Engine* engine);

  nn::ReadoutModule& readout() { return readout_; }

  // For the trunk's outputs as they are; `batch` as it was drawn. Leaves its gradient for the
  // trunk's next Backward.
  void ForwardBackward(const Transitions& batch);
  // The mean square of (0.15 y - label), in the labels' unit squared, after the next Gather.
  Number mean_square() const { return mean_square_; }

 private:
  AuxLoss(const Config& config, const ObservationSpec& spec, const nn::Features& trunk,
          Engine* engine);
  static std::vector<LabelColumns> LabelsOf(const Config& config, const ObservationSpec& spec);

  Engine* const engine_;
  const std::vector<LabelColumns> columns_;  // L
  const float weight_;
  nn::ReadoutModule readout_;
  const Array labels_, gradient_;  // (B, L)
  const Number mean_square_;
};

}  // namespace shoal::learner
