// SPDX-License-Identifier: Apache-2.0
#include "common/nn/observation_trunk.h"

#include <algorithm>

#include "common/base/check.h"

namespace shoal::nn {
ObservationTrunk::ObservationTrunk(const LayerContext& context, const HeadPlan& plan,
                                   const dnnl::memory& features,
                                   const dnnl::memory& features_gradient)
    : features_(plan.trunk_columns()),
      vector_size_(plan.vector_columns),
      extra_column_(features_ + vector_size_),
      input_(context.batch, extra_column_ + plan.extra_columns, Precision::kF32) {
  if (features_ == 0) return;
  CHECK(plan.trunk.layers().size() == 1);
  dense_.emplace(context, plan.trunk.layers()[0], features, features_gradient, Precision::kF32);
  if (context.training) {
    readout_gradient_.emplace(context.batch, features_, Precision::kF32);
    std::fill_n(readout_gradient_->values(), readout_gradient_->size(), 0.f);
  }
  own_features_.emplace(dense_->output().f32(),
                        readout_gradient_ ? readout_gradient_->f32() : dnnl::memory());
}

void ObservationTrunk::Refresh() {
  if (dense_) dense_->Refresh();
}

void ObservationTrunk::Forward(const float* vector) {
  if (dense_) {
    dense_->Forward();
    input_.SetColumns(0, features_, dense_->output().values());
  }
  input_.SetColumns(features_, vector_size_, vector);
}

void ObservationTrunk::Backward(const float* input_gradient) {
  if (!dense_) return;
  float* gradient = dense_->output_gradient().values();
  for (int b = 0; b < input_.batch(); ++b) {
    std::copy_n(input_gradient + int64_t(b) * input_.columns(), features_,
                gradient + int64_t(b) * features_);
  }
  for (int i = 0; i < readout_gradient_->size(); ++i) gradient[i] += readout_gradient_->values()[i];
  std::fill_n(readout_gradient_->values(), readout_gradient_->size(), 0.f);
  dense_->Backward({.parameters = true, .source = true});
}

}  // namespace shoal::nn
