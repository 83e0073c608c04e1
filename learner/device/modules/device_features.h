// SPDX-License-Identifier: Apache-2.0
// Features in the memory of a device, which networks of a device read.
#pragma once

#include "common/nn/network_plan.h"
#include "common/nn/networks.h"
#include "learner/device/workspace.h"

namespace shoal::learner::device {

// Output of an encoder: a map (B, h, w, padded channels) in the compute type. Output of a trunk:
// rows (B, columns) f32, which is a map of one pixel.
class DeviceFeatures final : public nn::Features {
 public:
  // map: without padding. gradient: null if there is none. Borrows the arrays.
  DeviceFeatures(Type type, const nn::MapShape& map, int padded_channels, const void* values,
                 void* gradient)
      : type_(type),
        map_(map),
        padded_channels_(padded_channels),
        values_(values),
        gradient_(gradient) {}

  // CHECKs that a network of a device computes the features.
  static const DeviceFeatures& Of(const nn::Features& features);

  int columns() const override { return int(map_.size()); }
  int padded_columns() const { return padded_channels_ * map_.height * map_.width; }
  Type type() const { return type_; }
  const nn::MapShape& map() const { return map_; }
  int padded_channels() const { return padded_channels_; }
  const void* values() const { return values_; }
  // dL/dvalues, in the type of the values. Its reader also learns whether it was written.
  void* gradient() const { return gradient_; }
  void SetHasGradient(bool has) const { has_gradient_ = has; }
  bool has_gradient() const { return has_gradient_; }

 private:
  const Type type_;
  const nn::MapShape map_;
  const int padded_channels_;
  const void* const values_;
  void* const gradient_;
  mutable bool has_gradient_ = false;
};

}  // namespace shoal::learner::device
