// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/aux_loss.h"

#include <cmath>
#include <string>

#include "common/base/check.h"
#include "common/config/privileged_blocks.h"

namespace shoal::learner {
namespace {

constexpr float kUnit = 0.15f;

}  // namespace

std::unique_ptr<AuxLoss> AuxLoss::Make(const Config& config, const ObservationSpec& spec,
                                       const nn::Features* trunk,
                                       const nn::ModuleContext& context) {
  if (config.learner.aux.empty()) return nullptr;
  CHECK(trunk != nullptr);
  return std::unique_ptr<AuxLoss>(new AuxLoss(config, spec, *trunk, context));
}

AuxLoss::AuxLoss(const Config& config, const ObservationSpec& spec, const nn::Features& trunk,
                 const nn::ModuleContext& context)
    : labels_(LabelsOf(config.learner, spec)),
      vector_size_(size_t(spec.VectorSize())),
      privileged_size_(size_t(PrivilegedSize(config.learner, spec))),
      weight_(float(config.learner.aux_weight)),
      readout_("aux", int(labels_.size()), trunk, context),
      gradient_(size_t(context.batch) * labels_.size()) {
  readout_.parameters().Initialise(uint64_t(config.seed));
  readout_.Refresh();
}

std::vector<AuxLoss::Label> AuxLoss::LabelsOf(const LearnerConfig& learner,
                                              const ObservationSpec& spec) {
  const PrivilegedBlocks blocks = PrivilegedBlocksOf(learner, spec);
  const auto column = [&](const std::string& block, int i) -> Column {
    if (const auto range = spec.Observed(block)) return {true, size_t(range->first + i)};
    int first = 0;
    for (const std::string& name : blocks.all) {
      if (name == block) return {false, size_t(first + i)};
      first += spec.Recorded(name)->size;
    }
    CHECK(false) << block;
    return {};
  };
  std::vector<Label> labels;
  for (const AuxLabel& label : blocks.labels) {
    for (int i = 0; i < label.size; ++i) {
      Label& number = labels.emplace_back(Label{column(label.block, i), std::nullopt});
      if (!label.minus.empty()) number.minus = column(label.minus, i);
    }
  }
  return labels;
}

float AuxLoss::Value(const BatchView& batch, size_t row, const Column& column) const {
  return column.observed ? batch.obs_vector[row * vector_size_ + column.at]
                         : batch.obs_privileged[row * privileged_size_ + column.at];
}

double AuxLoss::ForwardBackward(const BatchView& batch) {
  const float* y = readout_.Forward();
  const float scale = 2 * weight_ / float(gradient_.size());
  double squares = 0;
  for (size_t i = 0; i < gradient_.size(); ++i) {
    const size_t row = i / labels_.size();
    const Label& label = labels_[i % labels_.size()];
    float value = Value(batch, row, label.number);
    if (label.minus) value -= Value(batch, row, *label.minus);
    const float difference = y[i] - value / kUnit;
    squares += double(difference) * difference;
    gradient_[i] = scale * difference;
  }
  readout_.Backward(gradient_.data());
  return double(kUnit) * kUnit * squares / double(gradient_.size());
}

}  // namespace shoal::learner
