// SPDX-License-Identifier: Apache-2.0
#include "common/nn/readout_module.h"

#include <algorithm>

#include "common/nn/features.h"
#include "common/nn/host_memory.h"
#include "common/nn/linear.h"
#include "common/nn/network_plan.h"
#include "common/nn/parallel.h"
#include "common/nn/primitive_descs.h"

namespace shoal::nn {
namespace {

std::vector<ParameterSpec> Parameters(const std::string& name, int inputs, int outputs) {
  NetworkPlan plan({inputs});
  plan.Add(NetworkPlan::Linear{.name = name, .key = "sac.aux", .outputs = outputs});
  return plan.Parameters();
}

int Columns(const Features& trunk) { return int(DimsOf(trunk.values())[1]); }

}  // namespace

struct ReadoutModule::Impl {
  Linear linear;
};

ReadoutModule::ReadoutModule(const std::string& name, int outputs, const Features& trunk,
                             const ModuleContext& context)
    : Module(Parameters(name, Columns(trunk), outputs), Use::kTraining, context) {
  const ThreadScope scope(context.threads);
  impl_ = std::make_unique<Impl>(Impl{Linear(ToLayerContext(&parameters_, Use::kTraining, context),
                                             name, trunk.values(), trunk.gradient())});
}

ReadoutModule::~ReadoutModule() = default;

void ReadoutModule::Refresh() {
  const ThreadScope scope(context_.threads);
  impl_->linear.Refresh();
}

Array ReadoutModule::Forward() {
  const ThreadScope scope(context_.threads);
  impl_->linear.Forward();
  const auto size = size_t(context_.batch) * size_t(impl_->linear.outputs());
  return HostArray(std::span(impl_->linear.output(), size));
}

void ReadoutModule::Backward(Array gradient) {
  const ThreadScope scope(context_.threads);
  std::ranges::copy(HostValues(gradient), impl_->linear.output_gradient());
  impl_->linear.Backward({.parameters = true, .source = true});
}

}  // namespace shoal::nn
