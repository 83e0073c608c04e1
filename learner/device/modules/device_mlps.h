// SPDX-License-Identifier: Apache-2.0
// MLPs of one shape that read the same input: the Q functions of a critic, or one MLP. Types and
// formulas: common/nn/mlp.h.
//
// Dimensions: C functions, B rows, W columns of the input.
#pragma once

#include <memory>
#include <vector>

#include "learner/device/modules/dense_layer.h"

namespace shoal::learner::device {

class DeviceMlps {
 public:
  // input: (B, W) f32.
  DeviceMlps(Workspace* workspace, const DeviceParameters& parameters,
             const std::vector<nn::NetworkPlan>& plans, const float* input, bool trained);

  int count() const { return count_; }
  int outputs() const { return layers_.back()->outputs(); }
  const float* output() const { return layers_.back()->output(); }  // (C, B, outputs)
  int64_t output_step() const { return layers_.back()->step(); }
  // dL/dinput (C, B, W), which Backward computes.
  const float* input_gradient() const { return input_gradient_; }

  void Forward();
  // output_gradient: (C, B, outputs).
  void Backward(const float* output_gradient, const BackwardPart& part);

 private:
  const int count_;
  float* input_gradient_ = nullptr;
  std::vector<float*> gradients_;  // dL/dy of hidden layer i
  std::vector<std::unique_ptr<DenseLayer>> layers_;
};

}  // namespace shoal::learner::device
