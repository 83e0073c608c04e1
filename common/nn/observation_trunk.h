// What an MLP sees of an observation: the trunk's features (linear, LayerNorm, tanh of the feature
// map) beside the vector (Eq. 3 of docs/algorithm.md).
//
//   input[b] = [ tanh(LN(weight features[b] + bias)) | vector[b] | extra columns ]
//
// Without pixels there is no trunk: input[b] = [ vector[b] | extra columns ].
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/nn/dense_layer.h"
#include "common/nn/layer_context.h"
#include "common/nn/rows.h"
#include "common/spec/observation_spec.h"

namespace shoal::nn {

class ObservationTrunk {
 public:
  // Parameters `head`.trunk.*. features: the encoder's, empty without pixels. features_gradient:
  // where Backward puts dL/dfeatures; empty: never asked for. extra_columns: left to the caller.
  ObservationTrunk(const LayerContext& context, const std::string& head,
                   const ObservationSpec& spec, int extra_columns, const dnnl::memory& features,
                   const dnnl::memory& features_gradient);

  // (B, F + V + extra). Whoever fills the extra columns commits it.
  Rows& input() { return input_; }
  const Rows& input() const { return input_; }
  int extra_column() const { return extra_column_; }

  void Refresh();
  // vector (B, V); unread when V = 0.
  void Forward(const float* vector);
  // dL/dinput (B, F + V + extra), the sum over everybody who read the input.
  void Backward(const float* input_gradient);

 private:
  std::optional<DenseLayer> dense_;
  int features_ = 0, vector_size_, extra_column_;
  Rows input_;
  std::vector<float> dense_gradient_;  // (B, F)
};

}  // namespace shoal::nn
