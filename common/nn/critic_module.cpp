// SPDX-License-Identifier: Apache-2.0
#include "common/nn/critic_module.h"

#include "common/nn/critic_heads.h"
#include "common/nn/features.h"
#include "common/nn/host_memory.h"
#include "common/nn/parallel.h"

namespace shoal::nn {

struct CriticModule::Impl {
  CriticHeads heads;
  size_t outputs;  // of each function, a row
};

CriticModule::CriticModule(const HeadPlan& plan, const Features* features, bool trains_encoder,
                           Use use, const ModuleContext& context)
    : Module(plan.Parameters(), use, context) {
  const ThreadScope scope(context.threads);
  const FeatureSource source = ToFeatureSource(features, trains_encoder);
  impl_ = std::make_unique<Impl>(Impl{
      CriticHeads(ToLayerContext(&parameters_, use, context), plan, source.values, source.gradient),
      size_t(plan.mlps[0].output().channels)});
}

CriticModule::~CriticModule() = default;

int CriticModule::count() const { return impl_->heads.count(); }

Array CriticModule::q(int i) const {
  return HostArray(std::span(impl_->heads.q(i), size_t(context_.batch) * impl_->outputs));
}

const Features* CriticModule::trunk_features() const { return impl_->heads.trunk_features(); }

void CriticModule::Refresh() {
  const ThreadScope scope(context_.threads);
  impl_->heads.Refresh();
}

void CriticModule::ForwardObservation(Array vector) {
  const ThreadScope scope(context_.threads);
  impl_->heads.ForwardObservation(HostValues(vector).data());
}

void CriticModule::ForwardAction(Array action) {
  const ThreadScope scope(context_.threads);
  impl_->heads.ForwardAction(HostValues(action).data());
}

void CriticModule::Backward(Gradients q_gradients) {
  const ThreadScope scope(context_.threads);
  impl_->heads.Backward(q_gradients);
}

void CriticModule::BackwardAction(Gradients q_gradients, Array action_gradient) {
  const ThreadScope scope(context_.threads);
  impl_->heads.BackwardAction(q_gradients, HostValues(action_gradient).data());
}

}  // namespace shoal::nn
