// SPDX-License-Identifier: Apache-2.0
// A convolution, then ReLU if the plan has a ReLU and no batch normalisation. Formulas:
// common/nn/conv.h.
#pragma once

#include "learner/device/modules/device_map_layer.h"

namespace shoal::learner::device {

class DeviceConvolution final : public DeviceMapLayer {
 public:
  DeviceConvolution(Workspace* workspace, const nn::LayerPlan& plan,
                    const DeviceParameters& parameters, const MapSource& source, bool trained);

  // Sets the order of the layer's parameters.
  static void SetLayout(const Workspace& workspace, const nn::LayerPlan& plan,
                        ParameterLayout* layout);

  void Forward(nn::Statistics statistics) override;
  void Backward() override;

 private:
  const MapSource source_;
  const kernels::Activation activation_;
  ConvolutionShape shape_;
  Tensor weight_, bias_;
  const bool has_bias_;
};

}  // namespace shoal::learner::device
