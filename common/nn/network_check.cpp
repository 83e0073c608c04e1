// SPDX-License-Identifier: Apache-2.0
#include "common/nn/network_check.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "common/base/error.h"
#include "common/nn/actor_critic_plan.h"

namespace shoal::nn {
namespace {

constexpr int64_t kHeaderBytesPerTensor = 256;  // name, type, shape and offsets in JSON
constexpr int64_t kMostNumbers = std::numeric_limits<int>::max();

// Layers of every network of the policy and the critics.
std::vector<LayerPlan> Layers(const NetworkConfig& network, const ObservationSpec& spec,
                              bool policy_alone) {
  std::vector<LayerPlan> layers;
  const auto add = [&](const NetworkPlan& plan) {
    layers.insert(layers.end(), plan.layers().begin(), plan.layers().end());
  };
  const auto add_head = [&](const HeadPlan& head) {
    add(head.trunk);
    for (const NetworkPlan& mlp : head.mlps) add(mlp);
  };
  add(PlanEncoder(network, spec));
  add_head(PlanActor(network, spec));
  if (!policy_alone) add_head(PlanCritic(network, spec, "critic"));
  return layers;
}

int64_t Bytes(const ParameterSpec& parameter) {
  int64_t bytes = sizeof(float);
  for (const int64_t extent : parameter.shape) bytes *= extent;
  return bytes;
}

void CheckArrays(const NetworkConfig& network, const ObservationSpec& spec, int batch) {
  for (const LayerPlan& layer : Layers(network, spec, /*policy_alone=*/false)) {
    const bool in = layer.input.size() > layer.output.size();
    const int64_t numbers = std::max(layer.input.size(), layer.output.size());
    if (numbers <= kMostNumbers / batch) continue;
    throw UsageError(
        "{}: the {} of {} are {} numbers for each of learner.batch = {}, expected at most {} in "
        "all",
        layer.key, in ? "inputs" : "outputs", layer.name, numbers, batch, kMostNumbers);
  }
}

// The variance of a batch needs more than one value.
void CheckStatistics(const NetworkConfig& network, const ObservationSpec& spec, int batch) {
  const NetworkPlan encoder = PlanEncoder(network, spec);
  for (const LayerPlan& layer : encoder.layers()) {
    const int64_t values = int64_t{batch} * layer.output.height * layer.output.width;
    if (layer.batch_norm.empty() || values > 1) continue;
    throw UsageError(
        "learner.batch = {}: {} of network.encoder = {} has 1x1 maps of these images, whose batch "
        "statistics take at least 2 of them",
        batch, layer.batch_norm, network.encoder);
  }
}

void CheckPolicySize(const NetworkConfig& network, const ObservationSpec& spec,
                     int64_t most_bytes) {
  const int64_t bytes = PolicyBytes(network, spec);
  if (bytes <= most_bytes) return;
  ParameterSpec largest;
  std::string key;
  for (const LayerPlan& layer : Layers(network, spec, /*policy_alone=*/true)) {
    for (const ParameterSpec& parameter : layer.Parameters()) {
      if (!largest.name.empty() && Bytes(parameter) <= Bytes(largest)) continue;
      largest = parameter;
      key = layer.key;
    }
  }
  throw UsageError(
      "{}: the policy's parameters take {:.1f} MB ({} alone {:.1f} MB), expected at most {:.1f} "
      "MB, which one message holds",
      key, double(bytes) / 1e6, largest.name, double(Bytes(largest)) / 1e6,
      double(most_bytes) / 1e6);
}

}  // namespace

int64_t PolicyBytes(const NetworkConfig& network, const ObservationSpec& spec) {
  int64_t bytes = kHeaderBytesPerTensor;
  for (const ParameterSpec& parameter : PolicyParameters(network, spec)) {
    bytes += Bytes(parameter) + kHeaderBytesPerTensor;
  }
  return bytes;
}

void CheckNetwork(const NetworkConfig& network, const ObservationSpec& spec, int batch,
                  int64_t most_bytes) {
  CheckStatistics(network, spec, batch);
  CheckArrays(network, spec, batch);
  CheckPolicySize(network, spec, most_bytes);
}

}  // namespace shoal::nn
