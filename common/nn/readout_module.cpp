// SPDX-License-Identifier: Apache-2.0
#include "common/nn/readout_module.h"

#include <algorithm>

#include "common/nn/features.h"
#include "common/nn/host_memory.h"
#include "common/nn/linear.h"
#include "common/nn/network_plan.h"
#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

class HostReadout final : public ReadoutNetwork {
 public:
  HostReadout(const std::string& name, const HostFeatures& trunk, const LayerContext& context,
              int threads)
      : threads_(threads),
        linear_(context, name, trunk.values(), trunk.gradient()),
        values_(size_t(context.batch) * size_t(linear_.outputs())) {}

  void Refresh() override {
    const ThreadScope scope(threads_);
    linear_.Refresh();
  }
  Array Forward() override {
    const ThreadScope scope(threads_);
    linear_.Forward();
    return HostArray(std::span(linear_.output().values(), values_));
  }
  void Backward(Array gradient) override {
    const ThreadScope scope(threads_);
    std::ranges::copy(HostValues(gradient), linear_.output_gradient().values());
    linear_.Backward({.parameters = true, .source = true});
  }

 private:
  const int threads_;
  Linear linear_;
  const size_t values_;  // (B, L)
};

std::vector<ParameterSpec> Parameters(const std::string& name, int inputs, int outputs) {
  NetworkPlan plan({inputs});
  plan.Add(NetworkPlan::Linear{.name = name, .key = "sac.aux", .outputs = outputs});
  return plan.Parameters();
}

std::unique_ptr<ReadoutNetwork> MakeReadoutNetwork(const std::string& name, const Features& trunk,
                                                   ParameterSet* parameters,
                                                   const ModuleContext& context) {
  if (context.maker != nullptr) return context.maker->MakeReadout(name, trunk, parameters);
  const ThreadScope scope(context.threads);
  return std::make_unique<HostReadout>(name, OnHost(trunk),
                                       ToLayerContext(parameters, Module::Use::kTraining, context),
                                       context.threads);
}

}  // namespace

ReadoutModule::ReadoutModule(const std::string& name, int outputs, const Features& trunk,
                             const ModuleContext& context)
    : Module(Parameters(name, trunk.columns(), outputs), Use::kTraining, context),
      network_(MakeReadoutNetwork(name, trunk, &parameters_, context)) {}

}  // namespace shoal::nn
