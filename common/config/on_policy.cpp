// SPDX-License-Identifier: Apache-2.0
#include "common/config/on_policy.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string_view>

#include "common/base/error.h"
#include "common/config/algorithm_kind.h"
#include "common/config/config_io.h"

namespace shoal {
namespace {

using nlohmann::ordered_json;

// Keys that say how transitions are stored and reused. A name that ends with a dot is a section.
constexpr std::string_view kOffPolicyKeys[] = {"replay.",
                                               "exploration.",
                                               "lockstep_steps",
                                               "learner.actor_learning_rate",
                                               "learner.critic_learning_rate",
                                               "learner.reward_scale",
                                               "learner.tau",
                                               "learner.average_rate",
                                               "learner.actor_period",
                                               "learner.target_period",
                                               "learner.mean_penalty",
                                               "learner.bounded_targets",
                                               "learner.weights_period",
                                               "learner.request_credits",
                                               "network.log_std",
                                               "network.encoders",
                                               "network.target_encoder"};

const ordered_json& ValueAt(const ordered_json& keys, std::string path) {
  std::ranges::replace(path, '.', '/');
  return keys.at(ordered_json::json_pointer(fmt::format("/{}", path)));
}

// The first changed key: `path` itself or, if `path` is a section, one of its keys. Empty if all
// are at their defaults.
std::string FirstChanged(std::string_view path, const ordered_json& asked,
                         const ordered_json& usual) {
  if (path.ends_with('.')) {
    const std::string section(path.substr(0, path.size() - 1));
    for (const auto& [name, value] : asked.at(section).items()) {
      if (value != usual.at(section).at(name)) return fmt::format("{}.{}", section, name);
    }
    return "";
  }
  const std::string key(path);
  return ValueAt(asked, key) == ValueAt(usual, key) ? "" : key;
}

std::string OffPolicyAlgorithms() {
  return AlgorithmsThat([](const auto& kind) { return !kind.on_policy; });
}

void RefuseOffPolicyKeys(const Config& config) {
  const ordered_json asked = ToJson(config), usual = ToJson(Config());
  for (const std::string_view path : kOffPolicyKeys) {
    const std::string key = FirstChanged(path, asked, usual);
    if (key.empty()) continue;
    throw UsageError(
        "{} = {}: learner.algorithm = {} learns from rollouts, past the replay; expected it unset "
        "({}), or learner.algorithm = {}",
        key, ValueAt(asked, key).dump(), config.learner.algorithm, ValueAt(usual, key).dump(),
        OffPolicyAlgorithms());
  }
}

void RefuseKeysOfOthers(const Config& config) {
  const std::string_view own = AlgorithmKindOf(config).own_section;
  const ordered_json asked = ToJson(config), usual = ToJson(Config());
  for (const AlgorithmKind& other : AlgorithmKinds()) {
    if (other.own_section.empty() || other.own_section == own) continue;
    const std::string key = FirstChanged(other.own_section, asked, usual);
    if (key.empty()) continue;
    throw UsageError("{} belongs to learner.algorithm = {}: expected not to be set beside {}", key,
                     other.name, config.learner.algorithm);
  }
}

void ValidateRollout(const Config& config) {
  const int steps = config.ppo.rollout_steps;
  if (steps < 2) {
    throw UsageError(
        "ppo.rollout_steps = {}: a rollout needs a step to learn from and one that its value is "
        "bootstrapped by; expected at least 2",
        steps);
  }
  if (config.actors == 0) return;  // the number of actors is not known yet
  const int64_t envs = int64_t{config.actors} * config.envs_per_actor;
  const int64_t batch = config.learner.batch, rows = steps * envs;
  constexpr int64_t kMostRows = std::numeric_limits<int>::max();
  if (rows > kMostRows) {
    throw UsageError(
        "ppo.rollout_steps = {}: {} actor(s) with {} environments each play {} steps for one "
        "update; expected at most {}",
        steps, config.actors, config.envs_per_actor, rows, kMostRows);
  }
  if (rows % batch == 0) return;
  const int64_t unit = batch / std::gcd(batch, envs);
  throw UsageError(
      "ppo.rollout_steps = {}: {} steps of {} actor(s) with {} environments each are {}, which "
      "learner.batch = {} does not divide; expected a multiple of {}, {} for one",
      steps, steps, config.actors, config.envs_per_actor, rows, batch, unit,
      (steps + unit - 1) / unit * unit);
}

}  // namespace

bool LearnsOnPolicy(const Config& config) { return AlgorithmKindOf(config).on_policy; }

void ValidateOnPolicy(const Config& config) {
  RefuseKeysOfOthers(config);
  if (!LearnsOnPolicy(config)) return;
  RefuseOffPolicyKeys(config);
  if (config.observation.goal_mode == "image") {
    throw UsageError(
        "observation.goal_mode = image: rollouts of learner.algorithm = {} carry no goal pictures; "
        "expected none, desired or both, or learner.algorithm = {}",
        config.learner.algorithm, OffPolicyAlgorithms());
  }
  ValidateRollout(config);
  if (config.lockstep && config.ppo.versions_ahead > 0) {
    throw UsageError(
        "ppo.versions_ahead = {}: in lockstep an actor awaits each version; expected 0",
        config.ppo.versions_ahead);
  }
}

}  // namespace shoal
