// SPDX-License-Identifier: Apache-2.0
// Multi-layer perceptron: hidden layers and a linear output. The first layer is computed in the
// type of its input, the inner layers in the network's precision, and the output layer in f32.
// LayerNorms are computed in f32.
#pragma once

#include <memory>
#include <vector>

#include "common/nn/hidden_layer.h"
#include "common/nn/layer_context.h"
#include "common/nn/linear.h"
#include "common/nn/rows.h"

namespace shoal::nn {

class Mlp {
 public:
  // The plan's last layer is the output. Borrows `input`. The owner of `input` must call
  // Rows::Commit before Forward.
  Mlp(const LayerContext& context, const NetworkPlan& plan, const Rows& input);

  int outputs() const { return output_->outputs(); }
  const float* output() const { return output_->output().values(); }  // (B, outputs)
  // dL/dinput, in the shape of `input`; computed by Backward if wanted.source is set.
  const float* input_gradient() const { return input_gradient_.values(); }

  void Refresh();
  void Forward();
  // output_gradient: (B, outputs).
  void Backward(const float* output_gradient, Gradients wanted);

 private:
  struct Hidden {
    std::unique_ptr<HiddenLayer> layer;
    // Later layer that adds this layer's input to its own output; null if there is none. Its
    // gradient is added to the gradient of the input.
    HiddenLayer* skipping = nullptr;
  };

  Rows input_gradient_;
  std::vector<Hidden> hidden_;
  std::unique_ptr<Linear> output_;
};

}  // namespace shoal::nn
