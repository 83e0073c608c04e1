// Linear layer, optional LayerNorm, activation.
//
//   y = act(LN(weight x + bias))
#pragma once

#include <string>
#include <vector>

#include "common/nn/layer_context.h"
#include "common/nn/linear.h"
#include "common/nn/rows.h"

namespace shoal::nn {

enum class Activation { kRelu, kTanh };

class DenseLayer {
 public:
  // Parameters as Linear, and `name`.norm.{weight, bias} (O) where the set has them.
  // `output_precision` is the type in which the next layer reads output().
  DenseLayer(const LayerContext& context, const std::string& name, Activation activation,
             const dnnl::memory& source, const dnnl::memory& source_gradient,
             Precision output_precision);

  const Rows& output() const { return output_; }

  void Refresh() { linear_.Refresh(); }
  void Forward();
  // output_gradient: dL/dy (B, O).
  void Backward(const float* output_gradient, Gradients wanted);

 private:
  Linear linear_;
  Activation activation_;
  bool has_norm_;
  Parameter norm_weight_, norm_bias_;
  std::vector<float> normalised_;  // xhat (B, O)
  std::vector<float> scales_;      // rstd (B)
  Rows output_;
};

}  // namespace shoal::nn
