// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/network_start.h"

#include <fmt/ranges.h>

#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/nn/actor_critic_plan.h"

namespace shoal::learner {
namespace {

constexpr std::string_view kMoments = "observation.moments";

// Whether a tensor of learner.safetensors belongs to no network and so keeps its initial value.
bool IsLeftAlone(std::string_view name) {
  return name.starts_with("adam.") || name.starts_with("agent.") ||
         name.starts_with("temperature.") || name.starts_with("reward.");
}

bool IsPolicys(std::string_view name) {
  return name.starts_with("encoder.") || name.starts_with("actor.");
}

void RefuseNonFinite(const std::string& name, const nn::NamedTensor& tensor,
                     const std::string& source) {
  for (size_t i = 0; tensor.dtype == "F32" && i < tensor.data.size(); i += sizeof(float)) {
    float value;
    std::memcpy(&value, tensor.data.data() + i, sizeof(value));
    if (std::isfinite(value)) continue;
    throw UsageError("{}: tensor {} holds {}, expected finite numbers", source, name, value);
  }
}

void RefuseMisfit(const std::string& name, const nn::NamedTensor& tensor, const nn::TensorMap& own,
                  const std::string& source) {
  const auto at = own.find(name);
  if (at == own.end()) {
    throw UsageError("{}: tensor {} is none of this run's networks", source, name);
  }
  if (tensor.dtype != at->second.dtype) {
    throw UsageError("{}: tensor {} is {}, expected {}", source, name, tensor.dtype,
                     at->second.dtype);
  }
  if (tensor.shape != at->second.shape) {
    throw UsageError("{}: tensor {} has shape {}, expected {}", source, name,
                     fmt::join(tensor.shape, "x"), fmt::join(at->second.shape, "x"));
  }
  RefuseNonFinite(name, tensor, source);
}

// A policy's own file contains mean and variance, but not the number of observations.
void RefuseStatisticsAlone(const nn::TensorMap& weights, const std::string& source) {
  if (!weights.contains(nn::kObservationMean) || weights.contains(std::string(kMoments))) return;
  throw UsageError(
      "{}: the policy normalises observations, and how many {} is of stands only in "
      "its checkpoint's learner.safetensors: expected that file",
      source, nn::kObservationMean);
}

// The network of the agent that `name` copies (a target, or the trained copy of a policy's latent
// state), or "". A target's encoder copies its critic's encoder, if there is one, rather than the
// policy's.
std::string FollowedBy(const std::string& name, const nn::TensorMap& own) {
  constexpr std::pair<std::string_view, const char*> kFollowing[] = {{"target.", "critic."},
                                                                     {"target.", "actor."},
                                                                     {"target_actor.", "actor."},
                                                                     {"model.", "actor."}};
  for (const auto& [copy, network] : kFollowing) {
    if (!name.starts_with(copy)) continue;
    std::string followed = network + name.substr(copy.size());
    if (own.contains(followed)) return followed;
  }
  return "";
}

// The tensor from which a tensor of the agent starts, or null for the usual initial value.
const nn::NamedTensor* SourceOf(const std::string& name, const nn::TensorMap& weights,
                                const nn::TensorMap& own) {
  if (IsLeftAlone(name)) return nullptr;
  const auto find = [&](const std::string& wanted) {
    const auto at = weights.find(wanted);
    return at == weights.end() ? nullptr : &at->second;
  };
  if (const auto* given = find(name)) return given;
  if (const auto* followed = find(FollowedBy(name, own))) return followed;
  for (size_t dot = name.find('.'); dot != std::string::npos; dot = name.find('.', dot + 1)) {
    if (const auto* repeated = find(name.substr(dot + 1))) return repeated;
  }
  return nullptr;
}

}  // namespace

nn::TensorMap StartTensors(const nn::TensorMap& weights, const std::string& source,
                           const Agent& agent) {
  RefuseStatisticsAlone(weights, source);
  const nn::TensorMap own = agent.AllTensors();
  for (const auto& [name, weight] : weights) {
    if (!IsLeftAlone(name)) RefuseMisfit(name, weight, own, source);
  }
  for (const auto& [name, tensor] : own) {
    if (!IsPolicys(name) || weights.contains(name)) continue;
    throw UsageError("{}: tensor {} is missing", source, name);
  }
  nn::TensorMap result = own;
  for (auto& [name, tensor] : result) {
    if (const auto* weight = SourceOf(name, weights, own)) tensor = *weight;
  }
  return result;
}

}  // namespace shoal::learner
