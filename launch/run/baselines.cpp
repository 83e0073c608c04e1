// SPDX-License-Identifier: Apache-2.0
#include "launch/run/baselines.h"

#include <fmt/core.h>

#include <cstdlib>

#include "actor/evaluation/random_baseline.h"
#include "actor/worlds/physics_library.h"
#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/or_null.h"
#include "common/base/random.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kPolicies[] = {"noop", "random"};

ordered_json FiguresJson(const EvaluationFigures& figures) {
  return {{"task", figures.task},
          {"success", OrNull(figures.success)},
          {"episodes", figures.episodes},
          {"return_mean", figures.return_mean},
          {"return_std", figures.return_std},
          {"final_distance_mean", OrNull(figures.final_distance_mean)}};
}

// Empty if the file is missing or unreadable: the baseline is then measured again.
std::optional<EvaluationFigures> ReadIfGood(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return std::nullopt;
  try {
    return ReadEvaluationFigures(file);
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::string FormatFloor(const EvaluationFigures& figures) {
  return figures.success ? fmt::format("{:.1f} %", 100 * *figures.success)
                         : fmt::format("return {:.1f}", figures.return_mean);
}

}  // namespace

bool ShareBaselines(const Config& a, const Config& b) {
  return a.task == b.task && a.env.id == b.env.id && a.env.kwargs.json == b.env.kwargs.json &&
         a.distance_threshold == b.distance_threshold && a.model == b.model &&
         a.physics == b.physics && a.action_repeat == b.action_repeat &&
         a.end_on_success == b.end_on_success;
}

fs::path BaselineFolder() {
  const char *const cache = std::getenv("XDG_CACHE_HOME"), *const home = std::getenv("HOME");
  if (cache != nullptr && *cache != '\0') return fs::path(cache) / "shoal/baselines";
  if (home != nullptr && *home != '\0') return fs::path(home) / ".cache/shoal/baselines";
  return fs::temp_directory_path() / "shoal/baselines";
}

fs::path BaselineCache::FileOf(const Config& config, const std::string& policy) const {
  const std::string model = config.model.empty() ? "" : ReadFile(config.model);
  std::string key =
      fmt::format("{} {} {} {} {} {}", config.task, config.distance_threshold, config.physics,
                  config.action_repeat, episodes_, HashBytes(model.data(), model.size()));
  if (config.end_on_success) key += " end_on_success";  // else as in builds without it
  return folder_ /
         fmt::format("{}-{}-{:016x}.json", config.task, policy, HashBytes(key.data(), key.size()));
}

bool HasBaselines(const Config& config) { return config.env.id.empty(); }

std::optional<Baselines> BaselineCache::Find(const Config& config) const {
  if (!HasBaselines(config)) return std::nullopt;
  std::error_code error;
  if (!config.model.empty() && !fs::is_regular_file(config.model, error)) return std::nullopt;
  const auto noop = ReadIfGood(FileOf(config, kPolicies[0]));
  const auto random = ReadIfGood(FileOf(config, kPolicies[1]));
  if (!noop || !random) return std::nullopt;
  return Baselines{*noop, *random};
}

std::optional<Baselines> BaselineCache::Measure(
    const Config& config, const std::function<bool()>& stop,
    const std::function<void(const std::string&)>& say) const {
  CHECK(HasBaselines(config)) << config.env.id;
  if (const auto found = Find(config)) return found;
  say(
      fmt::format("measuring baselines of {}: {} episodes each with no-op and with random actions, "
                  "stored in {}",
                  config.task, episodes_, folder_.string()));
  MakeFolders(folder_);
  worlds::LoadTasks(config.task_library);
  for (const char* policy : kPolicies) {
    const fs::path file = FileOf(config, policy);
    if (ReadIfGood(file)) continue;
    try {
      const ordered_json result =
          actor::PlayRandom({.task = config.task,
                             .model = config.model,
                             .episodes = episodes_,
                             .policy = policy,
                             .distance_threshold = config.distance_threshold,
                             .action_repeat = config.action_repeat,
                             .physics = config.physics,
                             .end_on_success = config.end_on_success},
                            stop);
      WriteFileAtomically(file, result.dump() + "\n");
    } catch (const Error&) {
      if (stop()) return std::nullopt;  // PlayRandom throws when stopped
      throw;
    }
  }
  const auto measured = Find(config);
  if (!measured) throw RuntimeError("baselines in '{}' cannot be read back", folder_.string());
  return measured;
}

ordered_json ToJson(const std::optional<Baselines>& baselines) {
  if (!baselines) return ordered_json::object();
  return {{"noop", FiguresJson(baselines->noop)}, {"random", FiguresJson(baselines->random)}};
}

std::string FormatBaselines(const Baselines& baselines) {
  return fmt::format("without a policy: no-op {}, random {} ({} episodes each)",
                     FormatFloor(baselines.noop), FormatFloor(baselines.random),
                     baselines.noop.episodes);
}

}  // namespace shoal::launch
