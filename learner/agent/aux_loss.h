// SPDX-License-Identifier: Apache-2.0
// The auxiliary loss of learner.aux: linear functions of the trunk's outputs are to tell recorded
// blocks or differences of two, so that the encoder learns where things are before the critic
// knows what is worth anything (Eq. 27 of docs/algorithm.md). The policy has no part of it.
//
//   L = w / (B L) sum_(b,l) (y_(b,l) - label_(b,l) / 0.15)^2
//
// Labels are positions in m as a rule: 0.15 m is what they vary by.
//
// Dimensions: B batch, L labels.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "common/config/config.h"
#include "common/nn/readout_module.h"
#include "common/spec/observation_spec.h"
#include "common/wire/batch_schema.h"

namespace shoal::learner {

// One thread.
class AuxLoss {
 public:
  // Null without learner.aux. `trunk`: of the head that trains the encoder, which it borrows.
  static std::unique_ptr<AuxLoss> Make(const Config& config, const ObservationSpec& spec,
                                       const nn::Features* trunk, const nn::ModuleContext& context);

  nn::ReadoutModule& readout() { return readout_; }

  // For the trunk's outputs as they are; `batch` as it was drawn. Leaves its gradient for the
  // trunk's next Backward. The mean square of (0.15 y - label), in the labels' unit squared.
  double ForwardBackward(const BatchView& batch);

 private:
  // One number of a row: of obs_vector, or of obs_privileged.
  struct Column {
    bool observed;
    size_t at;
  };
  struct Label {
    Column number;
    std::optional<Column> minus;
  };

  AuxLoss(const Config& config, const ObservationSpec& spec, const nn::Features& trunk,
          const nn::ModuleContext& context);
  static std::vector<Label> LabelsOf(const LearnerConfig& learner, const ObservationSpec& spec);
  float Value(const BatchView& batch, size_t row, const Column& column) const;

  const std::vector<Label> labels_;  // L
  const size_t vector_size_, privileged_size_;
  const float weight_;
  nn::ReadoutModule readout_;
  std::vector<float> gradient_;  // (B, L)
};

}  // namespace shoal::learner
