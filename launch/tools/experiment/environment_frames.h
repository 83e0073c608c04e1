// SPDX-License-Identifier: Apache-2.0
// Environment frames: env steps x action repeat, the unit in which most papers count. A frame is
// one control step of the task.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/config/config.h"
#include "launch/record/evaluation_figures.h"

namespace shoal::launch {

// Control steps of an env step of a run with this configuration, resolved: never 0. Loads the
// configuration's task library. Throws Error if there is no such library or task.
int ActionRepeatOf(const Config& config);

// Return of one evaluation during training.
struct ReturnAtFrames {
  int64_t frames = 0;      // requested; the evaluation's own number may differ a little
  uint64_t env_steps = 0;  // at the evaluation
  size_t episodes = 0;
  double return_mean = 0;
};

// The evaluation of a curve (sorted by env steps) whose environment frames are nearest to `frames`;
// the later one of two that are equally near. Empty if they differ by more than 2 % of `frames`.
std::optional<ReturnAtFrames> FindReturnAt(int64_t frames,
                                           const std::vector<EvaluationFigures>& curve,
                                           int action_repeat);

}  // namespace shoal::launch
