// SPDX-License-Identifier: Apache-2.0
#include "common/config/live_values.h"

#include <algorithm>
#include <string_view>

#include "common/base/saturating_cast.h"

namespace shoal {
namespace {

// The value of a key that is at least 1.
uint64_t CountOf(const ControlState& control, std::string_view key, int64_t configured) {
  const std::optional<double> changed = control.Setting(key);
  if (!changed || *changed < 1) return static_cast<uint64_t>(configured);
  return SaturatingCast<uint64_t>(*changed);
}

}  // namespace

LiveValues LiveValuesOf(const Config& config, const ControlState& control) {
  LiveValues values{
      .env_steps = SaturatingCast<uint64_t>(
          control.SettingOr("env_steps", static_cast<double>(config.env_steps))),
      .actors = SaturatingCast<int>(control.SettingOr("actors", config.actors)),
      .weights_period = CountOf(control, "learner.weights_period", config.learner.weights_period),
      .eval_interval = CountOf(control, "eval.interval", config.eval.interval),
      .samples_per_insert = config.replay.samples_per_insert,
      .learner_threads = std::nullopt};
  if (const auto changed = control.Setting("replay.samples_per_insert")) {
    values.samples_per_insert = Schedule::Constant(*changed);
  }
  if (const auto changed = control.Setting("learner.threads")) {
    values.learner_threads = SaturatingCast<int>(*changed);
  }
  return values;
}

}  // namespace shoal
