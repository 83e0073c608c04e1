// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/goal_change.h"

#include <algorithm>
#include <utility>

#include "common/base/check.h"

namespace shoal::replay {

GoalChange::GoalChange(const ObservationSpec& spec, tasks::Task task,
                       std::span<const std::string> privileged, bool end_on_success)
    : layout_(spec),
      task_(std::move(task)),
      end_on_success_(end_on_success),
      desired_(spec.Observed(task_.desired_goal().name)) {
  const auto achieved = spec.Recorded(task_.achieved_goal().name);
  CHECK(task_.goal_size() > 0 && achieved && (desired_ || spec.goal_picture)) << spec.Summary();
  CHECK(achieved->size == task_.goal_size() && (!desired_ || desired_->size == task_.goal_size()));
  achieved_ = *achieved;
  size_t first = 0;
  for (const BlockSpec& block : spec.blocks) {  // privileged blocks are packed in this order
    if (std::ranges::find(privileged, block.name) == privileged.end()) continue;
    if (block.name == task_.desired_goal().name) privileged_first_ = first;
    first += size_t(block.size);
  }
}

std::span<const float> GoalChange::Achieved(const uint8_t* record) const {
  return layout_.Vector(record).subspan(size_t(achieved_.first), size_t(achieved_.size));
}

float GoalChange::Reward(const uint8_t* record, std::span<const float> goal) const {
  return task_.Reward(task_.Distance(Achieved(record), goal));
}

bool GoalChange::Terminated(const uint8_t* record, std::span<const float> goal) const {
  const uint8_t flags = RecordLayout::Header(record).flags;
  const bool terminated = (flags & kTerminated) != 0;
  if (!end_on_success_) return terminated;
  // A fall ends the episode under every goal. An episode that only success ended would have
  // continued.
  const bool by_the_world = terminated && (flags & kSuccess) == 0;
  return by_the_world || task_.Success(task_.Distance(Achieved(record), goal));
}

void GoalChange::WriteGoal(std::span<const float> goal, std::span<float> observed,
                           std::span<float> privileged) const {
  if (desired_) std::ranges::copy(goal, observed.begin() + desired_->first);
  if (privileged_first_ && !privileged.empty()) {
    std::ranges::copy(goal, privileged.begin() + std::ptrdiff_t(*privileged_first_));
  }
}

}  // namespace shoal::replay
