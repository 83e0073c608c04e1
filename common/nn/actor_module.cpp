// SPDX-License-Identifier: Apache-2.0
#include "common/nn/actor_module.h"

#include "common/nn/actor_head.h"
#include "common/nn/features.h"
#include "common/nn/host_memory.h"
#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

class HostActor final : public ActorNetwork {
 public:
  HostActor(const ActorPlan& plan, const FeatureSource& source, const LayerContext& context,
            int threads)
      : threads_(threads), head_(context, plan, source.values, source.gradient) {}

  const Features* trunk_features() const override { return head_.trunk_features(); }
  void Refresh() override {
    const ThreadScope scope(threads_);
    head_.Refresh();
  }
  ActorArrays Forward(Array vector) override {
    const ThreadScope scope(threads_);
    head_.Forward(HostValues(vector).data());
    return {Outputs(head_.mean()), Outputs(head_.log_std()), Outputs(head_.action())};
  }
  void Backward(Array mean_gradient, Array log_std_gradient) override {
    const ThreadScope scope(threads_);
    head_.Backward(HostValues(mean_gradient).data(), HostValues(log_std_gradient).data());
  }
  void BackwardAction(Array action_gradient, double mean_penalty) override {
    const ThreadScope scope(threads_);
    head_.BackwardAction(HostValues(action_gradient).data(), mean_penalty);
  }

 private:
  Array Outputs(const float* values) const {
    const auto size = size_t(head_.batch()) * size_t(head_.action_size());
    return values == nullptr ? Array() : HostArray(std::span(values, size));
  }

  const int threads_;
  ActorHead head_;
};

std::unique_ptr<ActorNetwork> MakeActorNetwork(const ActorPlan& plan, const Features* features,
                                               bool trains_encoder, ParameterSet* parameters,
                                               Module::Use use, const ModuleContext& context) {
  if (context.maker != nullptr) {
    return context.maker->MakeActor(plan, features, trains_encoder, use, parameters);
  }
  const ThreadScope scope(context.threads);
  return std::make_unique<HostActor>(plan, ToFeatureSource(features, trains_encoder),
                                     ToLayerContext(parameters, use, context), context.threads);
}

}  // namespace

ActorModule::ActorModule(const ActorPlan& plan, const Features* features, bool trains_encoder,
                         Use use, const ModuleContext& context)
    : Module(plan.Parameters(), use, context),
      network_(MakeActorNetwork(plan, features, trains_encoder, &parameters_, use, context)) {}

}  // namespace shoal::nn
