// SPDX-License-Identifier: Apache-2.0
#include "common/nn/mlp.h"

#include <algorithm>

#include "common/nn/dense_layer.h"
#include "common/nn/norm_layer.h"

namespace shoal::nn {

namespace {

// Type in which hidden layer `i` stores its output for the next layer.
Precision OutputPrecision(const NetworkPlan& plan, size_t i, Precision inner) {
  const bool is_last = i + 2 == plan.layers().size();
  const bool is_normalised = plan.layers()[i + 1].kind == LayerPlan::Kind::kLayerNorm;
  return is_last || is_normalised ? Precision::kF32 : inner;
}

}  // namespace

Mlp::Mlp(const LayerContext& context, const NetworkPlan& plan, const Rows& input)
    : input_gradient_(context.batch, input.columns(), Precision::kF32) {
  const Rows* source = &input;
  const Rows* source_gradient = &input_gradient_;
  const size_t hidden_layers = plan.layers().size() - 1;
  for (size_t i = 0; i < hidden_layers; ++i) {
    const LayerPlan& layer = plan.layers()[i];
    const Precision precision = OutputPrecision(plan, i, context.precision);
    if (layer.kind == LayerPlan::Kind::kLayerNorm) {
      hidden_.push_back({std::make_unique<NormLayer>(context, layer, source->f32(),
                                                     source_gradient->f32(), precision)});
    } else {
      const Rows* skip =
          layer.skip == kNoLayer ? nullptr : &hidden_[size_t(layer.skip)].layer->output();
      hidden_.push_back({std::make_unique<DenseLayer>(context, layer, source->compute(),
                                                      source_gradient->f32(), precision, skip)});
    }
    HiddenLayer& added = *hidden_.back().layer;
    if (layer.skip != kNoLayer) hidden_[size_t(layer.skip) + 1].skipping = &added;
    source = &added.output();
    source_gradient = &added.output_gradient();
  }
  output_ = std::make_unique<Linear>(context, plan.layers().back().name, source->f32(),
                                     source_gradient->f32());
}

void Mlp::Refresh() {
  for (const Hidden& hidden : hidden_) hidden.layer->Refresh();
  output_->Refresh();
}

void Mlp::Forward() {
  for (const Hidden& hidden : hidden_) hidden.layer->Forward();
  output_->Forward();
}

void Mlp::Backward(const float* output_gradient, Gradients wanted) {
  const size_t size = size_t(input_gradient_.batch()) * size_t(output_->outputs());
  std::copy_n(output_gradient, size, output_->output_gradient().values());
  output_->Backward({wanted.parameters, wanted.source || !hidden_.empty()});
  for (size_t i = hidden_.size(); i-- > 0;) {
    hidden_[i].layer->Backward({wanted.parameters, wanted.source || i > 0});
    if (hidden_[i].skipping == nullptr) continue;
    Rows& sum = hidden_[i - 1].layer->output_gradient();
    const float* added = hidden_[i].skipping->output_gradient().values();
    for (int k = 0; k < sum.size(); ++k) sum.values()[k] += added[k];
  }
}

}  // namespace shoal::nn
