// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/value_bounds.h"

#include "common/base/error.h"
#include "common/tasks/task_registry.h"

namespace shoal::learner {

ValueBounds ValueBoundsOf(const LearnerConfig& learner) {
  if (!learner.bounded_targets) return {};
  return {.low = float(-learner.reward_scale / (1 - learner.discount)), .high = 0};
}

void CheckValueBounds(const RunConfig& run) {
  if (!run.config.learner.bounded_targets) return;
  const tasks::Task& task = tasks::FindTask(run.spec.task);
  if (task.goal_size() == 0 || task.reward_kind() != tasks::RewardKind::kSparse) {
    throw UsageError(
        "learner.bounded_targets = true: the rewards of task {} are not -1 and 0, so its values "
        "have other bounds; expected false",
        task.name());
  }
  const int repeat = task.ActionRepeat(run.config.action_repeat);
  if (repeat > 1) {
    throw UsageError(
        "learner.bounded_targets = true with action_repeat = {}: rewards are sums of -1 and 0; "
        "expected action_repeat = 1",
        repeat);
  }
  if (run.config.learner.discount >= 1) {
    throw UsageError(
        "learner.bounded_targets = true with learner.discount = {}: values have no bound; expected "
        "a discount below 1",
        run.config.learner.discount);
  }
}

}  // namespace shoal::learner
