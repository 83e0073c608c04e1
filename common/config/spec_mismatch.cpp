// SPDX-License-Identifier: Apache-2.0
#include "common/config/spec_mismatch.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "common/base/bounded_json.h"
#include "common/base/one_line.h"

namespace shoal {
namespace {

// The first difference between two descriptions of an environment.
std::string EnvironmentDifference(const std::string& before, const std::string& now) {
  using nlohmann::json;
  const json was = ParseBoundedJson<json>(before), is = ParseBoundedJson<json>(now);
  for (const auto& [key, value] : was.items()) {
    const json other = is.value(key, json());
    if (other == value) continue;
    const auto shown = [](const json& part) { return Shortened(part.dump(), 300); };
    if (!value.is_array() || !other.is_array() || value.size() != other.size()) {
      return fmt::format("'{}' was {} and is {}", key, shown(value), shown(other));
    }
    for (size_t i = 0; i < value.size(); ++i) {
      if (value[i] == other[i]) continue;
      return fmt::format("'{}' was {} and is {}", key, shown(value[i]), shown(other[i]));
    }
  }
  return fmt::format("it was {} and is {}", Shortened(before, 300), Shortened(now, 300));
}

}  // namespace

std::string SpecMismatch(const RunConfig& run, const ObservationSpec& now) {
  if (!run.spec.environment.empty() && run.spec.environment != now.environment) {
    return fmt::format(
        "environment {} has changed since the run began: {}; expected the environment that the "
        "run was trained with",
        run.config.env.id, EnvironmentDifference(run.spec.environment, now.environment));
  }
  ObservationSpec same_model = now;
  same_model.model_fingerprint = run.spec.model_fingerprint;
  if (same_model == run.spec) {
    const Config& config = run.config;
    const std::string what = !config.model.empty() ? fmt::format("model file '{}'", config.model)
                             : !config.task_library.empty()
                                 ? fmt::format("the model of task {} (task library '{}')",
                                               config.task, config.task_library)
                                 : fmt::format("the model of task {}", config.task);
    return fmt::format(
        "{} has changed since the run began: its numbers, its cameras or MuJoCo's version differ; "
        "expected those that the run was trained with",
        what);
  }
  return fmt::format("the run observed [{}], this program's actors would observe [{}]",
                     run.spec.Summary(), now.Summary());
}

}  // namespace shoal
