// SPDX-License-Identifier: Apache-2.0
// An encoder: stacks of frames to features, which heads read where they lie.
#pragma once

#include <cstdint>
#include <memory>

#include "common/nn/array.h"
#include "common/nn/module.h"

namespace shoal::nn {

// Opaque: what heads are built on. Belongs to its encoder.
class Features;

class EncoderModule final : public Module {
 public:
  EncoderModule(const NetworkPlan& plan, Use use, const ModuleContext& context);
  ~EncoderModule() override;

  const Features& features() const;
  void Refresh() override;
  // frames (B, K*C, H, W) u8. The features stay until the next call. `statistics` says by what an
  // encoder with batch normalisation normalises, others do not mind: kBatch in the pass that
  // Backward and an optimiser's step follow, which moves the running ones along; kRunning in
  // targets and in all passes of a module for inference.
  void Forward(Frames frames, Statistics statistics);
  // Gradients of the parameters, from the gradient of the features that the latest Backward of a
  // head that trains this encoder left. Refers to the latest Forward.
  void Backward();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shoal::nn
