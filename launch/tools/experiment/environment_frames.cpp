// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/environment_frames.h"

#include <cmath>

#include "common/tasks/task_library.h"
#include "common/tasks/task_registry.h"

namespace shoal::launch {
namespace {

// Actors finish the vector step in which an evaluation becomes due, so evaluations are a little
// late.
constexpr double kTolerance = 0.02;

}  // namespace

int ActionRepeatOf(const Config& config) {
  if (config.action_repeat > 0) return config.action_repeat;
  // Descriptions of environments other than Shoal's worlds have no repeat of their own.
  if (!config.env.id.empty()) return 1;
  tasks::LoadTaskLibrary(config.task_library);
  return tasks::FindTask(config.task).ActionRepeat(config.action_repeat);
}

std::optional<ReturnAtFrames> FindReturnAt(int64_t frames,
                                           const std::vector<EvaluationFigures>& curve,
                                           int action_repeat) {
  const auto asked = static_cast<double>(frames);
  double nearest = kTolerance * asked;
  std::optional<ReturnAtFrames> found;
  for (const EvaluationFigures& point : curve) {
    const double distance = std::abs(static_cast<double>(point.env_steps) * action_repeat - asked);
    if (distance > nearest) continue;
    nearest = distance;
    found = {frames, point.env_steps, point.episodes, point.return_mean};
  }
  return found;
}

}  // namespace shoal::launch
