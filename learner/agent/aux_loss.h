// SPDX-License-Identifier: Apache-2.0
// The auxiliary loss of sac.aux (Eq. 27 of docs/algorithm.md). It trains linear functions of the
// trunk's outputs to predict recorded blocks, or differences of two blocks, so that the encoder
// learns the positions of objects before the critic's values are useful. The policy does not
// contain these functions.
//
//   L = w / (B L) sum_(b,l) (y_(b,l) - label_(b,l) / 0.15)^2
//
// Labels are usually positions in m, and 0.15 m is their typical variation.
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

// Only one thread may use an object.
class AuxLoss {
 public:
  // Makes the loss; returns null without sac.aux. Borrows the engine and `trunk`, which belongs to
  // the head that trains the encoder.
  static std::unique_ptr<AuxLoss> Make(const Config& config, const ObservationSpec& spec,
                                       const nn::Features* trunk, Engine* engine);

  nn::ReadoutModule& readout() { return readout_; }

  // Computes the loss for the trunk's current outputs, and writes the gradient for the trunk's next
  // Backward. `batch`: the batch before normalisation.
  void ForwardBackward(const Transitions& batch);
  // The mean square of (0.15 y - label), in the labels' unit squared. Valid after the next Gather.
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
