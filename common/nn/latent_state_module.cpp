// SPDX-License-Identifier: Apache-2.0
#include "common/nn/latent_state_module.h"

#include <algorithm>
#include <vector>

#include "common/base/check.h"
#include "common/nn/dense_layer.h"
#include "common/nn/features.h"
#include "common/nn/host_memory.h"
#include "common/nn/observation_trunk.h"
#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

HeadPlan TrunkOf(const StatePlan& plan) {
  return {.trunk = plan.trunk, .vector_columns = plan.vector_columns};
}

}  // namespace

struct LatentStateModule::Network {
  Network(const StatePlan& plan, const FeatureSource& source, const LayerContext& context)
      : trunk(context, TrunkOf(plan), source.values, source.gradient),
        input_gradient(context.batch, trunk.input().columns(), Precision::kF32) {
    const Rows* input = &trunk.input();
    const Rows* gradient = &input_gradient;
    for (const LayerPlan& layer : plan.layers.layers()) {
      layers.push_back(std::make_unique<DenseLayer>(context, layer, input->f32(), gradient->f32(),
                                                    Precision::kF32));
      input = &layers.back()->output();
      gradient = &layers.back()->output_gradient();
    }
  }

  const Rows& output() const { return layers.empty() ? trunk.input() : layers.back()->output(); }
  Rows& output_gradient() {
    return layers.empty() ? input_gradient : layers.back()->output_gradient();
  }

  ObservationTrunk trunk;
  Rows input_gradient;
  std::vector<std::unique_ptr<DenseLayer>> layers;
};

LatentStateModule::LatentStateModule(const StatePlan& plan, const Features* features,
                                     bool trains_encoder, Use use, const ModuleContext& context)
    : Module(plan.Parameters(), use, context),
      network_(std::make_unique<Network>(plan, ToFeatureSource(features, trains_encoder),
                                         ToLayerContext(&parameters_, use, context))) {
  CHECK(context.maker == nullptr) << "latent states are computed on the CPU";
}

LatentStateModule::~LatentStateModule() = default;

void LatentStateModule::Refresh() {
  const ThreadScope scope(context_.threads);
  network_->trunk.Refresh();
  for (const auto& layer : network_->layers) layer->Refresh();
}

Array LatentStateModule::Forward(Array vector) {
  const ThreadScope scope(context_.threads);
  network_->trunk.Forward(HostValues(vector).data());
  network_->trunk.input().Commit();
  for (const auto& layer : network_->layers) layer->Forward();
  const Rows& output = network_->output();
  return HostArray(std::span(output.values(), size_t(output.size())));
}

void LatentStateModule::Backward(Array gradient) {
  const ThreadScope scope(context_.threads);
  std::ranges::copy(HostValues(gradient), network_->output_gradient().values());
  const bool wants_input = network_->trunk.NeedsInputGradient();
  for (size_t i = network_->layers.size(); i-- > 0;) {
    network_->layers[i]->Backward({.parameters = true, .source = wants_input || i > 0});
  }
  network_->trunk.Backward(network_->input_gradient.values());
}

}  // namespace shoal::nn
