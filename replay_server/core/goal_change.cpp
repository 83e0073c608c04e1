#include "replay_server/core/goal_change.h"

#include <algorithm>
#include <utility>

#include "common/base/check.h"

namespace shoal::replay {

GoalChange::GoalChange(const ObservationSpec& spec, tasks::Task task)
    : layout_(spec), task_(std::move(task)) {
  const auto achieved = spec.Recorded(task_.achieved_goal().name);
  const auto desired = spec.Observed(task_.desired_goal().name);
  CHECK(task_.goal_size() > 0 && achieved && desired) << spec.Summary();
  CHECK(achieved->size == task_.goal_size() && desired->size == task_.goal_size());
  achieved_ = *achieved;
  desired_ = *desired;
}

std::span<const float> GoalChange::Achieved(const uint8_t* record) const {
  return layout_.Vector(record).subspan(size_t(achieved_.first), size_t(achieved_.size));
}

float GoalChange::Reward(const uint8_t* record, std::span<const float> goal) const {
  return task_.Reward(task_.Distance(Achieved(record), goal));
}

void GoalChange::WriteGoal(std::span<const float> goal, std::span<float> observed) const {
  std::ranges::copy(goal, observed.begin() + desired_.first);
}

}  // namespace shoal::replay
