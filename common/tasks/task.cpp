// SPDX-License-Identifier: Apache-2.0
#include "common/tasks/task.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/tasks/task_check.h"

namespace shoal::tasks {

Task::Task(Description description) : description_(std::move(description)) {
  CheckDescription(description_);
  observation_.name = "observation";
  for (const Block& block : description_.observation) {
    observation_.components.insert(observation_.components.end(), block.components.begin(),
                                   block.components.end());
  }
}

int Task::EnvStepsPerEpisode(int repeat) const {
  CHECK(repeat > 0) << repeat;
  return (description_.episode_length + repeat - 1) / repeat;
}

Task Task::WithThreshold(double metres) const {
  if (goal_size() == 0) {
    throw UsageError("distance_threshold = {}: task {} has no goals", metres, name());
  }
  Task task = *this;
  task.description_.distance_threshold = metres;
  return task;
}

double Task::Distance(std::span<const float> achieved, std::span<const float> desired) const {
  const auto size = static_cast<size_t>(goal_size());
  CHECK(size > 0) << name() << " has no goals";
  CHECK(achieved.size() == size && desired.size() == size) << achieved.size() << desired.size();
  double sum = 0;
  for (size_t i = 0; i < size; ++i) {
    const double difference = double{achieved[i]} - double{desired[i]};
    sum += difference * difference;
  }
  return std::sqrt(sum);
}

float Task::Reward(double distance) const {
  CHECK(goal_size() > 0) << name() << " has no goals";
  if (description_.reward == RewardKind::kDense) return static_cast<float>(-distance);
  return distance > description_.distance_threshold ? -1.0f : 0.0f;
}

void Task::ComputeRewards(std::span<const float> achieved, std::span<const float> desired,
                          std::span<float> reward) const {
  const auto size = static_cast<size_t>(goal_size());
  CHECK(achieved.size() == reward.size() * size) << achieved.size() << " for " << reward.size();
  CHECK(desired.size() == achieved.size()) << desired.size() << " for " << achieved.size();
  for (size_t i = 0; i < reward.size(); ++i) {
    reward[i] = Reward(Distance(achieved.subspan(i * size, size), desired.subspan(i * size, size)));
  }
}

}  // namespace shoal::tasks
