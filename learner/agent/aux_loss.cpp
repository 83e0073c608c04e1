// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/aux_loss.h"

#include <string>

#include "common/base/check.h"
#include "common/config/privileged_blocks.h"

namespace shoal::learner {
namespace {

constexpr float kUnit = 0.15f;

}  // namespace

std::unique_ptr<AuxLoss> AuxLoss::Make(const Config& config, const ObservationSpec& spec,
                                       const nn::Features* trunk, Engine* engine) {
  if (config.sac.aux.empty()) return nullptr;
  CHECK(trunk != nullptr);
  return std::unique_ptr<AuxLoss>(new AuxLoss(config, spec, *trunk, engine));
}

AuxLoss::AuxLoss(const Config& config, const ObservationSpec& spec, const nn::Features& trunk,
                 Engine* engine)
    : engine_(engine),
      columns_(LabelsOf(config, spec)),
      weight_(float(config.sac.aux_weight)),
      readout_("aux", int(columns_.size()), trunk, engine->modules()),
      labels_(engine->NewArray(int(columns_.size()))),
      gradient_(engine->NewArray(int(columns_.size()))),
      mean_square_(engine->NewNumber()) {
  readout_.parameters().Initialise(uint64_t(config.seed));
  readout_.Refresh();
}

std::vector<LabelColumns> AuxLoss::LabelsOf(const Config& config, const ObservationSpec& spec) {
  const PrivilegedBlocks blocks = PrivilegedBlocksOf(config, spec);
  const auto column = [&](const std::string& block, int i) -> LabelColumns::Column {
    if (const auto range = spec.Observed(block)) return {true, size_t(range->first + i)};
    int first = 0;
    for (const std::string& name : blocks.all) {
      if (name == block) return {false, size_t(first + i)};
      first += spec.Recorded(name)->size;
    }
    CHECK(false) << block;
    return {};
  };
  std::vector<LabelColumns> labels;
  for (const AuxLabel& label : blocks.labels) {
    for (int i = 0; i < label.size; ++i) {
      LabelColumns& number = labels.emplace_back(LabelColumns{column(label.block, i), {}});
      if (!label.minus.empty()) number.minus = column(label.minus, i);
    }
  }
  return labels;
}

void AuxLoss::ForwardBackward(const Transitions& batch) {
  const Array y = readout_.Forward();
  engine_->GatherLabels(batch.obs_vector, batch.obs_privileged, columns_, kUnit, labels_);
  engine_->LabelLoss(y, labels_, weight_, kUnit, gradient_, mean_square_);
  readout_.Backward(gradient_);
}

}  // namespace shoal::learner
