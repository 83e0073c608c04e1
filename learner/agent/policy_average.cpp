// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/policy_average.h"

#include "common/nn/module.h"

namespace shoal::learner {

PolicyAverage::PolicyAverage(const std::vector<nn::ParameterSet*>& policy, Engine* engine)
    : policy_(policy), engine_(engine) {
  for (const nn::ParameterSet* set : policy_) {
    averages_.emplace_back(set->specs(), nn::ParameterSet::Use::kInference,
                           engine_->modules().replica);
  }
}

void PolicyAverage::Copy() {
  for (size_t p = 0; p < averages_.size(); ++p) {
    nn::CopyParameters(*policy_[p], &averages_[p]);
  }
}

void PolicyAverage::Move(float rate) {
  for (size_t p = 0; p < policy_.size(); ++p) {
    engine_->MoveAverage(rate, *policy_[p], &averages_[p]);
  }
}

nn::TensorMap PolicyAverage::Tensors() const {
  nn::TensorMap tensors;
  for (const nn::ParameterSet& average : averages_) average.Export(&tensors);
  return tensors;
}

void PolicyAverage::AddTo(AgentState* state) {
  for (nn::ParameterSet& average : averages_) state->Add(&average, "average");
}

}  // namespace shoal::learner
