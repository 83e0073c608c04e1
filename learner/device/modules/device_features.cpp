// SPDX-License-Identifier: Apache-2.0
#include "learner/device/modules/device_features.h"

#include "common/base/check.h"

namespace shoal::learner::device {

const DeviceFeatures& DeviceFeatures::Of(const nn::Features& features) {
  const auto* of_device = dynamic_cast<const DeviceFeatures*>(&features);
  CHECK(of_device != nullptr) << "features of another engine";
  return *of_device;
}

}  // namespace shoal::learner::device
