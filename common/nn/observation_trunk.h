// SPDX-License-Identifier: Apache-2.0
// Input of the MLPs of a head: the trunk's features beside the vector (Eq. 3 of docs/algorithm.md).
//
//   input[b] = [ trunk(features[b]) | vector[b] | extra columns ]
//
// Without pixels there is no trunk: input[b] = [ vector[b] | extra columns ].
//
// The input is f32 in every precision, and so is the first layer of the MLP that reads it: between
// 1 and 2 neighbouring bf16 are 0.0078 apart, and a position of 1.34 m has to be known better. The
// layer is small: it costs less than 1 % of an update from pixels.
#pragma once

#include <optional>
#include <vector>

#include "common/nn/actor_critic_plan.h"
#include "common/nn/dense_layer.h"
#include "common/nn/features.h"
#include "common/nn/layer_context.h"
#include "common/nn/rows.h"

namespace shoal::nn {

class ObservationTrunk {
 public:
  // features: the encoder's, empty without pixels. features_gradient: where Backward puts
  // dL/dfeatures; empty: never asked for. The extra columns are left to the caller.
  ObservationTrunk(const LayerContext& context, const HeadPlan& plan, const dnnl::memory& features,
                   const dnnl::memory& features_gradient);

  // The trunk's outputs (B, F) f32, for a readout (readout_module.h), which may leave a gradient
  // there before Backward, in training. Null without pixels.
  const Features* features() const { return own_features_ ? &*own_features_ : nullptr; }

  // (B, F + V + extra) f32.
  Rows& input() { return input_; }
  const Rows& input() const { return input_; }
  int extra_column() const { return extra_column_; }

  void Refresh();
  // vector (B, V); unread when V = 0.
  void Forward(const float* vector);
  // dL/dinput (B, F + V + extra), the sum over everybody who read the input. What a readout left is
  // added to it, once.
  void Backward(const float* input_gradient);

 private:
  std::optional<DenseLayer> dense_;
  int features_, vector_size_, extra_column_;
  Rows input_;
  std::optional<Rows> readout_gradient_;  // dL/d(trunk's outputs) (B, F); 0: none was written
  std::optional<Features> own_features_;
  std::vector<float> dense_gradient_;  // (B, F)
};

}  // namespace shoal::nn
