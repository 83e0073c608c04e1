// SPDX-License-Identifier: Apache-2.0
// Current values of the keys that can change during a run (launch/run/live_settings.h). A value is
// that of the run's configuration, unless the coordinator has sent a change.
#pragma once

#include <cstdint>
#include <optional>

#include "common/config/config.h"
#include "common/wire/control_state.h"

namespace shoal {

struct LiveValues {
  uint64_t env_steps = 0;  // the budget
  int actors = 0;
  uint64_t weights_period = 0, eval_interval = 0;
  Schedule samples_per_insert;  // a change is a number, which replaces the schedule
  // Empty unless changed, because only the learner can resolve the value 0 of a configuration.
  std::optional<int> learner_threads;

  bool operator==(const LiveValues&) const = default;
};

// The present values of a run. A foreign program on an open network may send values outside of a
// key's range. Such a value is ignored or replaced by the nearest valid value.
LiveValues LiveValuesOf(const Config& config, const ControlState& control);

}  // namespace shoal
