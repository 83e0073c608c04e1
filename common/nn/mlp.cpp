// SPDX-License-Identifier: Apache-2.0
#include "common/nn/mlp.h"

#include <algorithm>

namespace shoal::nn {

Mlp::Mlp(const LayerContext& context, const NetworkPlan& plan, const Rows& input)
    : input_gradient_(context.batch, input.columns(), Precision::kF32) {
  const Rows* source = &input;
  const Rows* source_gradient = &input_gradient_;
  const size_t hidden_layers = plan.layers().size() - 1;
  for (size_t i = 0; i < hidden_layers; ++i) {
    const bool last = i + 1 == hidden_layers;
    hidden_.push_back(std::make_unique<DenseLayer>(context, plan.layers()[i], source->compute(),
                                                   source_gradient->f32(),
                                                   last ? Precision::kF32 : context.precision));
    source = &hidden_.back()->output();
    source_gradient = &hidden_.back()->output_gradient();
  }
  output_ = std::make_unique<Linear>(context, plan.layers().back().name, source->f32(),
                                     source_gradient->f32());
}

void Mlp::Refresh() {
  for (const auto& layer : hidden_) layer->Refresh();
  output_->Refresh();
}

void Mlp::Forward() {
  for (const auto& layer : hidden_) layer->Forward();
  output_->Forward();
}

void Mlp::Backward(const float* output_gradient, Gradients wanted) {
  const size_t size = size_t(input_gradient_.batch()) * size_t(output_->outputs());
  std::copy_n(output_gradient, size, output_->output_gradient().values());
  output_->Backward({wanted.parameters, wanted.source || !hidden_.empty()});
  for (size_t i = hidden_.size(); i-- > 0;) {
    hidden_[i]->Backward({wanted.parameters, wanted.source || i > 0});
  }
}

}  // namespace shoal::nn
