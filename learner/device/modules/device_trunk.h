// SPDX-License-Identifier: Apache-2.0
// Input of the MLPs of a head: [ trunk(features) | vector | extra columns ], f32. Formulas:
// common/nn/observation_trunk.h.
//
// Dimensions: B rows, F trunk outputs, V vector size, W = F + V + extra columns.
#pragma once

#include <optional>

#include "common/nn/actor_critic_plan.h"
#include "learner/device/modules/dense_layer.h"
#include "learner/device/modules/device_features.h"

namespace shoal::learner::device {

class DeviceTrunk {
 public:
  // features: null without pixels; borrowed.
  DeviceTrunk(Workspace* workspace, const DeviceParameters& parameters, const nn::HeadPlan& plan,
              const DeviceFeatures* features, bool trains_encoder, bool trained);

  // Sets the order of the trunk's weights.
  static void SetLayout(const nn::HeadPlan& plan, const DeviceFeatures* features,
                        ParameterLayout* layout);

  const float* input() const { return input_; }  // (B, W)
  int width() const { return width_; }
  int extra_column() const { return features_ + vector_size_; }
  // See ObservationTrunk::features.
  const DeviceFeatures* features() const { return own_features_ ? &*own_features_ : nullptr; }

  // Computes the trunk. vector (B, V) must stay unchanged until the last FillInput.
  void Forward(const float* vector);
  // Writes the input from the trunk's outputs, the vector and `extra`, the extra columns, which may
  // be null if there are none.
  void FillInput(const float* extra);
  // input_gradients: dL/dinput (C, B, W); their sum over C functions is the gradient.
  void Backward(const float* input_gradients, int count);

 private:
  Workspace* const workspace_;
  const int features_, vector_size_, extra_size_, width_;
  std::optional<DenseLayer> dense_;
  std::optional<DeviceFeatures> own_features_;
  float* const input_;
  float* gradient_ = nullptr;      // of the trunk's outputs (B, F)
  const float* vector_ = nullptr;  // of the latest Forward
};

}  // namespace shoal::learner::device
