// SPDX-License-Identifier: Apache-2.0
#include "common/nn/critic_module.h"

#include "common/nn/critic_heads.h"
#include "common/nn/features.h"
#include "common/nn/host_memory.h"
#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

class HostCritic final : public CriticNetwork {
 public:
  HostCritic(const HeadPlan& plan, const FeatureSource& source, const LayerContext& context,
             int threads)
      : threads_(threads),
        heads_(context, plan, source.values, source.gradient),
        values_(size_t(context.batch) * size_t(plan.mlps[0].output().channels)) {}

  int count() const override { return heads_.count(); }
  Array q(int i) const override { return HostArray(std::span(heads_.q(i), values_)); }
  const Features* trunk_features() const override { return heads_.trunk_features(); }
  void Refresh() override {
    const ThreadScope scope(threads_);
    heads_.Refresh();
  }
  void ForwardObservation(Array vector) override {
    const ThreadScope scope(threads_);
    heads_.ForwardObservation(HostValues(vector).data());
  }
  void ForwardAction(Array action) override {
    const ThreadScope scope(threads_);
    heads_.ForwardAction(HostValues(action).data());
  }
  void Backward(std::span<const Array> q_gradients) override {
    const ThreadScope scope(threads_);
    heads_.Backward(q_gradients);
  }
  void BackwardAction(std::span<const Array> q_gradients, Array action_gradient) override {
    const ThreadScope scope(threads_);
    heads_.BackwardAction(q_gradients, HostValues(action_gradient).data());
  }

 private:
  const int threads_;
  CriticHeads heads_;
  const size_t values_;  // of each function
};

std::unique_ptr<CriticNetwork> MakeCriticNetwork(const HeadPlan& plan, const Features* features,
                                                 bool trains_encoder, ParameterSet* parameters,
                                                 Module::Use use, const ModuleContext& context) {
  if (context.maker != nullptr) {
    return context.maker->MakeCritic(plan, features, trains_encoder, use, parameters);
  }
  const ThreadScope scope(context.threads);
  return std::make_unique<HostCritic>(plan, ToFeatureSource(features, trains_encoder),
                                      ToLayerContext(parameters, use, context), context.threads);
}

}  // namespace

CriticModule::CriticModule(const HeadPlan& plan, const Features* features, bool trains_encoder,
                           Use use, const ModuleContext& context)
    : Module(plan.Parameters(), use, context),
      network_(MakeCriticNetwork(plan, features, trains_encoder, &parameters_, use, context)) {}

std::vector<Array> CriticModule::values() const {
  std::vector<Array> values;
  values.reserve(size_t(count()));
  for (int i = 0; i < count(); ++i) values.push_back(q(i));
  return values;
}

}  // namespace shoal::nn
