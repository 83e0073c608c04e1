// SPDX-License-Identifier: Apache-2.0
// Values of the keys that can change during a run (launch/run/live_settings.h), as a process uses
// them: those of the run's configuration, replaced by the changes that the coordinator has sent.
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
  Schedule samples_per_insert;         // a change is a number, which replaces the schedule
  std::optional<int> learner_threads;  // only if changed: the learner resolves the configured 0

  bool operator==(const LiveValues&) const = default;
};

// The values of a run now. A foreign program on an open network may send changes out of a key's
// range; such changes are ignored or replaced by the nearest valid value.
LiveValues LiveValuesOf(const Config& config, const ControlState& control);

}  // namespace shoal
