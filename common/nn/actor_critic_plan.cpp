// SPDX-License-Identifier: Apache-2.0
#include "common/nn/actor_critic_plan.h"

#include <numbers>
#include <utility>

#include "common/base/error.h"
#include "common/nn/encoders/encoder_kind.h"
#include "common/nn/mlp_plan.h"

namespace shoal::nn {
namespace {

constexpr int kMostSide = 1024;  // largest value of observation.height

NetworkPlan BuildEncoder(const EncoderKind& kind, const NetworkConfig& network,
                         const MapShape& images, const std::string& name) {
  NetworkPlan plan(images);
  kind.add(network, name, &plan);
  return plan;
}

// Side of the smallest square images that the encoder takes; 0 if there are none.
int LeastSide(const EncoderKind& kind, const NetworkConfig& network, int channels) {
  for (int side = 1; side <= kMostSide; ++side) {
    try {
      BuildEncoder(kind, network, {channels, side, side}, "");
      return side;
    } catch (const Error&) {
      continue;
    }
  }
  return 0;
}

}  // namespace

NetworkPlan PlanEncoder(const NetworkConfig& network, const ObservationSpec& spec,
                        const std::string& name) {
  if (!spec.HasPixels()) return {};
  const EncoderKind& kind = FindEncoderKind(network.encoder);
  const MapShape images{spec.InputChannels(), spec.height, spec.width};
  try {
    return BuildEncoder(kind, network, images, name);
  } catch (const Error& error) {
    const int side = LeastSide(kind, network, images.channels);
    if (side <= std::min(spec.height, spec.width)) throw;  // the cause is not the size
    throw UsageError(
        "network.encoder = {}: images of {}x{} are too small ({}), expected at least "
        "{}x{}",
        kind.name, spec.height, spec.width, error.what(), side, side);
  }
}

std::vector<ParameterSpec> HeadPlan::Parameters() const {
  std::vector<ParameterSpec> parameters = trunk.Parameters();
  for (const NetworkPlan& mlp : mlps) Append(mlp.Parameters(), &parameters);
  return parameters;
}

ActorPlan PlanActor(const NetworkConfig& network, const ObservationSpec& spec, ActorOutput output,
                    const std::string& name) {
  ActorPlan plan;
  plan.trunk = PlanTrunk(network, spec, name);
  plan.vector_columns = spec.VectorSize();
  plan.output = output;
  plan.action_size = spec.action_size;
  plan.name = name;
  plan.log_std = network.log_std == "clamped" ? LogStd::kClamped : LogStd::kSmooth;
  const int outputs = (output == ActorOutput::kGaussian ? 2 : 1) * spec.action_size;
  NetworkPlan mlp({plan.trunk_columns() + plan.vector_columns});
  AddStateLayers(network, name + ".mlp", &mlp);
  AddMlp(network, {.name = name + ".mlp", .first = int(network.state_hidden.size())}, outputs,
         &mlp);
  plan.mlps.push_back(std::move(mlp));
  return plan;
}

std::vector<ParameterSpec> ActorPlan::Parameters() const {
  std::vector<ParameterSpec> parameters = HeadPlan::Parameters();
  if (output == ActorOutput::kUnsquashed) parameters.push_back({name + ".log_std", {action_size}});
  return parameters;
}

HeadPlan PlanObservationHead(const NetworkConfig& network, const ObservationSpec& spec,
                             const std::string& name, int outputs, double output_gain) {
  HeadPlan plan{.trunk = PlanTrunk(network, spec, name), .vector_columns = spec.VectorSize()};
  NetworkPlan mlp({plan.trunk_columns() + plan.vector_columns});
  AddMlp(network,
         {.name = name + ".mlp", .hidden_gain = std::numbers::sqrt2, .output_gain = output_gain},
         outputs, &mlp);
  plan.mlps.push_back(std::move(mlp));
  return plan;
}

HeadPlan PlanCritic(const NetworkConfig& network, const ObservationSpec& spec,
                    const std::string& name, int count, int outputs) {
  HeadPlan plan{.trunk = PlanTrunk(network, spec, name),
                .vector_columns = spec.VectorSize(),
                .extra_columns = spec.action_size};
  const int inputs = plan.trunk_columns() + plan.vector_columns + plan.extra_columns;
  for (int i = 1; i <= count; ++i) {
    NetworkPlan mlp({inputs});
    AddMlp(network, {.name = name + ".q" + std::to_string(i)}, outputs, &mlp);
    plan.mlps.push_back(std::move(mlp));
  }
  return plan;
}

std::vector<ParameterSpec> PolicyParameters(const NetworkConfig& network,
                                            const ObservationSpec& spec) {
  std::vector<ParameterSpec> parameters = PlanEncoder(network, spec).Parameters();
  Append(PlanActor(network, spec).Parameters(), &parameters);
  return parameters;
}

}  // namespace shoal::nn
