// SPDX-License-Identifier: Apache-2.0
#include "common/nn/critic_heads.h"

#include <algorithm>

#include "common/base/check.h"
#include "common/nn/host_memory.h"

namespace shoal::nn {

CriticHeads::CriticHeads(const LayerContext& context, const HeadPlan& plan,
                         const dnnl::memory& features, const dnnl::memory& features_gradient)
    : trunk_(context, plan, features, features_gradient),
      action_size_(plan.extra_columns),
      zeros_(size_t(context.batch) * size_t(plan.mlps[0].output().channels)),
      input_gradient_(size_t(trunk_.input().size())) {
  mlps_.reserve(plan.mlps.size());
  for (const NetworkPlan& mlp : plan.mlps) mlps_.emplace_back(context, mlp, trunk_.input());
}

void CriticHeads::Refresh() {
  trunk_.Refresh();
  for (Mlp& mlp : mlps_) mlp.Refresh();
}

void CriticHeads::ForwardObservation(const float* vector) { trunk_.Forward(vector); }

void CriticHeads::ForwardAction(const float* action) {
  trunk_.input().SetColumns(trunk_.extra_column(), action_size_, action);
  for (Mlp& mlp : mlps_) mlp.Forward();
}

void CriticHeads::BackwardMlps(QGradients q_gradients, Gradients wanted) {
  CHECK(q_gradients.size() == mlps_.size()) << q_gradients.size() << " gradients";
  int parts = 0;  // functions that are part of the loss, or pass zeros
  for (size_t i = 0; i < mlps_.size(); ++i) {
    const bool absent = !q_gradients[i];
    // Gradients of parameters are overwritten, so a function that is not part of the loss passes
    // zeros.
    if (absent && !wanted.parameters) continue;
    mlps_[i].Backward(absent ? zeros_.data() : HostValues(q_gradients[i]).data(), wanted);
    if (wanted.source) SumInputGradient(mlps_[i].input_gradient(), /*first=*/parts == 0);
    ++parts;
  }
  CHECK(parts > 0) << "no Q function is part of the loss";
}

void CriticHeads::SumInputGradient(const float* gradient, bool first) {
  if (first) {
    std::copy_n(gradient, input_gradient_.size(), input_gradient_.data());
  } else {
    for (size_t k = 0; k < input_gradient_.size(); ++k) input_gradient_[k] += gradient[k];
  }
}

void CriticHeads::Backward(QGradients q_gradients) {
  BackwardMlps(q_gradients, {.parameters = true, .source = trunk_.NeedsInputGradient()});
  trunk_.Backward(input_gradient_.data());
}

void CriticHeads::BackwardAction(QGradients q_gradients, float* action_gradient) {
  BackwardMlps(q_gradients, {.parameters = false, .source = true});
  const int columns = trunk_.input().columns();
  for (int b = 0; b < trunk_.input().batch(); ++b) {
    std::copy_n(input_gradient_.data() + int64_t{b} * columns + trunk_.extra_column(), action_size_,
                action_gradient + int64_t{b} * action_size_);
  }
}

}  // namespace shoal::nn
