// SPDX-License-Identifier: Apache-2.0
// Batch normalisation of a convolution's output, then the addition of another map and ReLU if the
// plan has them. Formulas: common/nn/batch_norm.h.
//
// A pass by statistics of the batch writes the next running statistics; the optimiser's next step
// applies them, and the end of an update that is not finite undoes it (kernels/optimiser.h).
#pragma once

#include "learner/device/modules/device_map_layer.h"

namespace shoal::learner::device {

class DeviceBatchNorm final : public DeviceMapLayer {
 public:
  // source: the convolution's output. The gradients of output and source are one array: Backward
  // replaces the output's gradient by that of the source. skip: empty if the plan has none.
  DeviceBatchNorm(Workspace* workspace, const nn::LayerPlan& plan,
                  const DeviceParameters& parameters, const DeviceMap& source,
                  const MapSource& skip, bool trained);

  // Sets the order of the layer's parameters.
  static void SetLayout(const Workspace& workspace, const nn::LayerPlan& plan,
                        ParameterLayout* layout);

  void Forward(nn::Statistics statistics) override;
  // The statistics of the latest Forward must have been kBatch.
  void Backward() override;

 private:
  void MeasureBatch();

  const DeviceMap source_;
  const MapSource skip_;
  const kernels::Activation activation_;
  const Tensor weight_, bias_, running_mean_, running_variance_;
  const int64_t rows_;                           // pixels of the batch
  float *mean_ = nullptr, *variance_ = nullptr;  // of the batch; null in inference
  kernels::ColumnSums sums_;                     // not in inference
  bool measured_ = false;                        // whether the latest Forward was kBatch
};

}  // namespace shoal::learner::device
