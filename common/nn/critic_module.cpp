// SPDX-License-Identifier: Apache-2.0
#include "common/nn/critic_module.h"

#include "common/nn/critic_heads.h"
#include "common/nn/features.h"
#include "common/nn/parallel.h"

namespace shoal::nn {

struct CriticModule::Impl {
  CriticHeads heads;
};

CriticModule::CriticModule(const HeadPlan& plan, const Features* features, bool trains_encoder,
                           Use use, const ModuleContext& context)
    : Module(plan.Parameters(), use, context) {
  const ThreadScope scope(context.threads);
  const FeatureSource source = ToFeatureSource(features, trains_encoder);
  impl_ = std::make_unique<Impl>(Impl{CriticHeads(ToLayerContext(&parameters_, use, context), plan,
                                                  source.values, source.gradient)});
}

CriticModule::~CriticModule() = default;

int CriticModule::count() const { return impl_->heads.count(); }

const float* CriticModule::q(int i) const { return impl_->heads.q(i); }

const Features* CriticModule::trunk_features() const { return impl_->heads.trunk_features(); }

void CriticModule::Refresh() {
  const ThreadScope scope(context_.threads);
  impl_->heads.Refresh();
}

void CriticModule::ForwardObservation(const float* vector) {
  const ThreadScope scope(context_.threads);
  impl_->heads.ForwardObservation(vector);
}

void CriticModule::ForwardAction(const float* action) {
  const ThreadScope scope(context_.threads);
  impl_->heads.ForwardAction(action);
}

void CriticModule::Backward(Gradients q_gradients) {
  const ThreadScope scope(context_.threads);
  impl_->heads.Backward(q_gradients);
}

void CriticModule::BackwardAction(Gradients q_gradients, float* action_gradient) {
  const ThreadScope scope(context_.threads);
  impl_->heads.BackwardAction(q_gradients, action_gradient);
}

}  // namespace shoal::nn
