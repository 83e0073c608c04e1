// SPDX-License-Identifier: Apache-2.0
#include "common/nn/encoder_module.h"

#include "common/nn/encoder.h"
#include "common/nn/features.h"
#include "common/nn/host_memory.h"
#include "common/nn/parallel.h"

namespace shoal::nn {

struct EncoderModule::Impl {
  Impl(const LayerContext& context, const NetworkPlan& plan)
      : encoder(context, plan), features(encoder.features(), encoder.features_gradient()) {}

  Encoder encoder;
  const Features features;
};

EncoderModule::EncoderModule(const NetworkPlan& plan, Use use, const ModuleContext& context)
    : Module(plan.Parameters(), use, context) {
  const ThreadScope scope(context.threads);
  impl_ = std::make_unique<Impl>(ToLayerContext(&parameters_, use, context), plan);
}

EncoderModule::~EncoderModule() = default;

const Features& EncoderModule::features() const { return impl_->features; }

void EncoderModule::Refresh() {
  const ThreadScope scope(context_.threads);
  impl_->encoder.Refresh();
}

void EncoderModule::Forward(Frames frames, Statistics statistics) {
  const ThreadScope scope(context_.threads);
  impl_->encoder.Forward(HostValues(frames).data(), statistics);
}

void EncoderModule::Backward() {
  const ThreadScope scope(context_.threads);
  impl_->encoder.Backward();
}

}  // namespace shoal::nn
