// SPDX-License-Identifier: Apache-2.0
// An encoder computes features from stacks of frames. Heads read the features without a copy.
#pragma once

#include <cstdint>
#include <memory>

#include "common/nn/array.h"
#include "common/nn/module.h"
#include "common/nn/networks.h"

namespace shoal::nn {

class EncoderModule final : public Module {
 public:
  EncoderModule(const NetworkPlan& plan, Use use, const ModuleContext& context);

  // Input of heads. The encoder owns it.
  const Features& features() const { return network_->features(); }
  void Refresh() override { network_->Refresh(); }
  // frames: B stacks of K frames (C, H, W), (B, K*C, H, W) u8. The features stay valid until the
  // next call. `statistics` matters only for an encoder with batch normalisation. Use kBatch in a
  // pass that is followed by Backward and an optimiser's step; this step also updates the running
  // statistics. Use kRunning in targets and in all passes of a module for inference.
  void Forward(Frames frames, Statistics statistics) { network_->Forward(frames, statistics); }
  // Computes the gradients of the parameters for the latest Forward. The gradient of the features
  // must have been written by the Backward of a head that trains this encoder.
  void Backward() { network_->Backward(); }

 private:
  const std::unique_ptr<EncoderNetwork> network_;
};

}  // namespace shoal::nn
