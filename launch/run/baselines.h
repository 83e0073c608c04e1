// SPDX-License-Identifier: Apache-2.0
// Baselines of a task: results of no-op actions and of uniform random actions, reported with every
// success rate. Baselines are measured once per task, threshold and model, and then stored.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "common/config/config.h"
#include "launch/record/evaluation_figures.h"

namespace shoal::launch {

struct Baselines {
  EvaluationFigures noop{}, random{};
};

// Whether two configurations have the same baselines: if task, environment of Python, threshold,
// model file, physics, action repeat and end_on_success are equal. All other keys concern the
// policy.
bool ShareBaselines(const Config& a, const Config& b);

// $XDG_CACHE_HOME/shoal/baselines, or ~/.cache/shoal/baselines; in /tmp if there is no home
// directory.
std::filesystem::path BaselineFolder();

// False for environments of Python, which only their actors can play.
bool HasBaselines(const Config& config);

class BaselineCache {
 public:
  static constexpr int kEpisodes = 400;

  explicit BaselineCache(std::filesystem::path folder = BaselineFolder(), int episodes = kEpisodes)
      : folder_(std::move(folder)), episodes_(episodes) {}

  // Baselines of the configuration's task with its threshold, content of the model file, physics,
  // action repeat and end_on_success, without pictures and randomization. Empty if the baselines
  // have not been measured, if the model file no longer exists, or if the configuration has no
  // baselines (HasBaselines).
  std::optional<Baselines> Find(const Config& config) const;
  // Like Find, but measures baselines that are not stored yet. A measurement plays whole episodes
  // and takes some seconds to a minute; `say` gets a line before the measurement. Empty if `stop`
  // returned true. Throws Error. CHECK: HasBaselines.
  std::optional<Baselines> Measure(const Config& config, const std::function<bool()>& stop,
                                   const std::function<void(const std::string&)>& say) const;

 private:
  std::filesystem::path FileOf(const Config& config, const std::string& policy) const;

  const std::filesystem::path folder_;
  const int episodes_;
};

// {noop: {task, success, episodes, return_mean, return_std, final_distance_mean}, random: {...}};
// {} without baselines.
nlohmann::ordered_json ToJson(const std::optional<Baselines>& baselines);

// "without a policy: no-op 6.8 %, random 4.0 % (400 episodes each)", or returns if the task has no
// success.
std::string FormatBaselines(const Baselines& baselines);

}  // namespace shoal::launch
