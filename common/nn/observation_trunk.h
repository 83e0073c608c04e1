// SPDX-License-Identifier: Apache-2.0
// Input of the MLPs of a head: the trunk's outputs, then the vector (Eq. 3 of docs/algorithm.md).
//
//   input[b] = [ trunk(features[b]) | vector[b] | extra columns ]
//
// Without pixels there is no trunk: input[b] = [ vector[b] | extra columns ].
//
// The input is f32 in every precision, and the first layer of each MLP is computed in f32. The
// reason: neighbouring bf16 numbers between 1 and 2 differ by 0.0078, which is too coarse for a
// position such as 1.34 m. The first layer costs less than 1 % of an update from pixels.
//
// Dimensions: B batch, F trunk outputs, V vector size.
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
  // features: output of the encoder; empty without pixels. features_gradient: memory to which
  // Backward writes dL/dfeatures; empty if no gradient is needed. The caller writes the extra
  // columns.
  ObservationTrunk(const LayerContext& context, const HeadPlan& plan, const dnnl::memory& features,
                   const dnnl::memory& features_gradient);

  // The trunk's outputs (B, F) f32, for a readout (readout_module.h). In training, the readout may
  // write their gradient before Backward. Null without pixels.
  const HostFeatures* features() const { return own_features_ ? &*own_features_ : nullptr; }

  // (B, F + V + extra) f32.
  Rows& input() { return input_; }
  const Rows& input() const { return input_; }
  int extra_column() const { return extra_column_; }

  void Refresh();
  // vector: (B, V); not read if V = 0.
  void Forward(const float* vector);
  // Whether Backward reads input_gradient: not without pixels.
  bool NeedsInputGradient() const { return dense_.has_value(); }
  // input_gradient: dL/dinput (B, F + V + extra), summed over all readers of the input. Backward
  // adds the gradient that a readout wrote, and then sets that gradient to 0.
  void Backward(const float* input_gradient);

 private:
  std::optional<DenseLayer> dense_;
  int features_, vector_size_, extra_column_;
  Rows input_;
  std::optional<Rows> readout_gradient_;  // dL/d(trunk's outputs) (B, F); 0 if no readout wrote it
  std::optional<HostFeatures> own_features_;
};

}  // namespace shoal::nn
