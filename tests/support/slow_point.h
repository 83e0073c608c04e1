// SPDX-License-Identifier: Apache-2.0
// A task whose steps take three milliseconds (tests/integration/crashing_point). Runs that wait for
// a time limit use this task, so that other tests can use the processors. The test needs the
// targets crashing_point and crashing_point_physics.
#pragma once

#include "tests/support/paths.h"
#include "tests/support/training_run.h"

namespace shoal {

// The keys of a run with this task; `keys` override these keys.
inline TrainingRun::Keys SlowPoint(const TrainingRun::Keys& keys) {
  TrainingRun::Keys all{{"task_library", ProgramPath("crashing_point.so")},
                        {"task", "CrashingPoint"},
                        {"observation.pixels", "false"}};
  for (const auto& [key, value] : keys) all[key] = value;
  return all;
}

}  // namespace shoal
