// SPDX-License-Identifier: Apache-2.0
#include "common/nn/encoder_module.h"

#include "common/nn/encoder.h"
#include "common/nn/features.h"
#include "common/nn/host_memory.h"
#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

class HostEncoder final : public EncoderNetwork {
 public:
  HostEncoder(const NetworkPlan& plan, const LayerContext& context, int threads)
      : threads_(threads),
        encoder_(context, plan),
        features_(encoder_.features(), encoder_.features_gradient()) {}

  const Features& features() const override { return features_; }
  void Refresh() override {
    const ThreadScope scope(threads_);
    encoder_.Refresh();
  }
  void Forward(Frames frames, Statistics statistics) override {
    const ThreadScope scope(threads_);
    encoder_.Forward(HostValues(frames).data(), statistics);
  }
  void Backward() override {
    const ThreadScope scope(threads_);
    encoder_.Backward();
  }

 private:
  const int threads_;
  Encoder encoder_;
  const HostFeatures features_;
};

std::unique_ptr<EncoderNetwork> MakeEncoderNetwork(const NetworkPlan& plan,
                                                   ParameterSet* parameters, Module::Use use,
                                                   const ModuleContext& context) {
  if (context.maker != nullptr) return context.maker->MakeEncoder(plan, use, parameters);
  const ThreadScope scope(context.threads);
  return std::make_unique<HostEncoder>(plan, ToLayerContext(parameters, use, context),
                                       context.threads);
}

}  // namespace

EncoderModule::EncoderModule(const NetworkPlan& plan, Use use, const ModuleContext& context)
    : Module(plan.Parameters(), use, context),
      network_(MakeEncoderNetwork(plan, &parameters_, use, context)) {}

}  // namespace shoal::nn
