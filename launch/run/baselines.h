// SPDX-License-Identifier: Apache-2.0
// Baselines of a task: results of no-op actions and of uniform random actions, reported beside
// every success rate. Measured once per task, threshold and model, then kept.
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

// Whether two configurations have the same baselines: equal in task, environment of Python,
// threshold, model file, physics, action repeat and whether episodes end on success. Everything
// else that they say is the policy's.
bool ShareBaselines(const Config& a, const Config& b);

// $XDG_CACHE_HOME/shoal/baselines, or ~/.cache/shoal/baselines; in /tmp where there is no home.
std::filesystem::path BaselineFolder();

// False for environments of Python, which no program but their actors can play.
bool HasBaselines(const Config& config);

class BaselineCache {
 public:
  static constexpr int kEpisodes = 400;

  explicit BaselineCache(std::filesystem::path folder = BaselineFolder(), int episodes = kEpisodes)
      : folder_(std::move(folder)), episodes_(episodes) {}

  // Those of the configuration's task with its threshold, model file (its content), physics, action
  // repeat and end of episodes, without pictures and randomization; empty if they have not been
  // measured, if the model file no longer exists, or if it has none (HasBaselines).
  std::optional<Baselines> Find(const Config& config) const;
  // The same, measured where they have not been: whole episodes, some seconds to a minute. `say`
  // gets a line before. Empty when `stop` said so. Throws Error. CHECK: HasBaselines.
  std::optional<Baselines> Measure(const Config& config, const std::function<bool()>& stop,
                                   const std::function<void(const std::string&)>& say) const;

 private:
  std::filesystem::path FileOf(const Config& config, const std::string& policy) const;

  const std::filesystem::path folder_;
  const int episodes_;
};

// {noop: {task, success, episodes, return_mean, return_std, final_distance_mean}, random: {...}};
// {} without.
nlohmann::ordered_json ToJson(const std::optional<Baselines>& baselines);

// "without a policy: no-op 6.8 %, random 4.0 % (400 episodes each)", returns where the task has no
// success.
std::string FormatBaselines(const Baselines& baselines);

}  // namespace shoal::launch
