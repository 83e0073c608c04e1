// SPDX-License-Identifier: Apache-2.0
// Linear layer, optional LayerNorm, optional activation, for several functions of one shape: the
// layers of the same place in the MLPs of a critic are computed together. Formulas:
// common/nn/dense_layer.h.
//
// Dimensions: C functions, B rows, I inputs, O outputs.
#pragma once

#include <string>
#include <vector>

#include "common/nn/network_plan.h"
#include "learner/device/device_parameters.h"
#include "learner/device/workspace.h"

namespace shoal::learner::device {

// Rows (C, B, I) that a layer reads, or (B, I) that all functions read (step 0).
struct LayerSource {
  Type type = Type::kF32;  // of the layer's products
  const void* values = nullptr;
  int columns = 0;   // I
  int64_t step = 0;  // from one function to the next
  // Destination of dL/dx (C, B, I); null: not computed.
  void* gradient = nullptr;
  Type gradient_type = Type::kF32;
};

// Functions [0, count) of a layer, and the gradients that a backward pass computes.
struct BackwardPart {
  int count = 1;
  bool parameters = true;
  bool source = true;
};

// The activation as kernels compute it.
kernels::Activation ActivationOf(nn::Activation activation);

class DenseLayer {
 public:
  // plans: one linear layer for each function, of the same shape. rounds: whether the output is
  // also needed in bf16. trained: whether there are backward passes. The parameters' values must be
  // in the mirror `parameters` when the layer runs.
  DenseLayer(Workspace* workspace, const DeviceParameters& parameters,
             const std::vector<nn::LayerPlan>& plans, const LayerSource& source, bool rounds,
             bool trained);

  int outputs() const { return outputs_; }
  const float* output() const { return output_; }              // (C, B, O)
  const uint16_t* rounded_output() const { return rounded_; }  // null if it is not needed
  int64_t step() const { return int64_t(workspace_->batch()) * outputs_; }

  void Forward();
  // output_gradient: dL/dy (C, B, O).
  void Backward(const float* output_gradient, const BackwardPart& part);

 private:
  // Parameters of one function.
  struct Function {
    Tensor weight, bias, norm_weight, norm_bias;
  };

  // Whether the product alone computes the output.
  bool ProductIsOutput() const;
  // Sums over the rows of `count` functions.
  kernels::ColumnSums Sums(int count) const;
  void OutputGradient(const float* output_gradient, const BackwardPart& part);
  void WeightGradients(int count, const void* gradient);
  void SourceGradient(int count, const void* gradient);

  Workspace* const workspace_;
  const LayerSource source_;
  const nn::Activation activation_;
  const bool has_norm_;
  const int outputs_;
  std::vector<Function> functions_;
  int64_t weight_step_ = 0, bias_step_ = 0;
  float* product_;               // weight x (C, B, O); output_ if that is the output
  float* output_;                // (C, B, O)
  uint16_t* rounded_ = nullptr;  // (C, B, O)
  float *normalised_ = nullptr, *scales_ = nullptr;  // xhat (C, B, O), rstd (C, B)
  // dL/d(weight x + bias) (C, B, O), in f32 and in the type of the products.
  float* gradient_ = nullptr;
  uint16_t* rounded_gradient_ = nullptr;
  float* partials_ = nullptr;
  int32_t* counters_ = nullptr;
};

}  // namespace shoal::learner::device
