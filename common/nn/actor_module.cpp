// SPDX-License-Identifier: Apache-2.0
#include "common/nn/actor_module.h"

#include "common/nn/actor_head.h"
#include "common/nn/features.h"
#include "common/nn/host_memory.h"
#include "common/nn/parallel.h"

namespace shoal::nn {

struct ActorModule::Impl {
  Array Outputs(const float* values) const {
    const auto size = size_t(head.batch()) * size_t(head.action_size());
    return values == nullptr ? Array() : HostArray(std::span(values, size));
  }

  ActorHead head;
};

ActorModule::ActorModule(const ActorPlan& plan, const Features* features, bool trains_encoder,
                         Use use, const ModuleContext& context)
    : Module(plan.Parameters(), use, context) {
  const ThreadScope scope(context.threads);
  const FeatureSource source = ToFeatureSource(features, trains_encoder);
  impl_ = std::make_unique<Impl>(Impl{
      ActorHead(ToLayerContext(&parameters_, use, context), plan, source.values, source.gradient)});
}

ActorModule::~ActorModule() = default;

const Features* ActorModule::trunk_features() const { return impl_->head.trunk_features(); }

void ActorModule::Refresh() {
  const ThreadScope scope(context_.threads);
  impl_->head.Refresh();
}

ActorModule::Output ActorModule::Forward(Array vector) {
  const ThreadScope scope(context_.threads);
  ActorHead& head = impl_->head;
  head.Forward(HostValues(vector).data());
  return {impl_->Outputs(head.mean()), impl_->Outputs(head.log_std()),
          impl_->Outputs(head.action())};
}

void ActorModule::Backward(Array mean_gradient, Array log_std_gradient) {
  const ThreadScope scope(context_.threads);
  impl_->head.Backward(HostValues(mean_gradient).data(), HostValues(log_std_gradient).data());
}

void ActorModule::BackwardAction(Array action_gradient, double mean_penalty) {
  const ThreadScope scope(context_.threads);
  impl_->head.BackwardAction(HostValues(action_gradient).data(), mean_penalty);
}

}  // namespace shoal::nn
