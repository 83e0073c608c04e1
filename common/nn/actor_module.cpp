// SPDX-License-Identifier: Apache-2.0
#include "common/nn/actor_module.h"

#include "common/nn/actor_head.h"
#include "common/nn/features.h"
#include "common/nn/parallel.h"

namespace shoal::nn {

struct ActorModule::Impl {
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

ActorModule::Output ActorModule::Forward(const float* vector) {
  const ThreadScope scope(context_.threads);
  impl_->head.Forward(vector);
  return {impl_->head.mean(), impl_->head.log_std(), impl_->head.action()};
}

void ActorModule::Backward(const float* mean_gradient, const float* log_std_gradient) {
  const ThreadScope scope(context_.threads);
  impl_->head.Backward(mean_gradient, log_std_gradient);
}

void ActorModule::BackwardAction(const float* action_gradient, double mean_penalty) {
  const ThreadScope scope(context_.threads);
  impl_->head.BackwardAction(action_gradient, mean_penalty);
}

}  // namespace shoal::nn
