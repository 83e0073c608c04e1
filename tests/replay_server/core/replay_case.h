// SPDX-License-Identifier: Apache-2.0
// The observation specs and sampling methods of the property tests.
#pragma once

#include <optional>

#include "common/spec/observation_spec.h"
#include "common/tasks/task.h"
#include "replay_server/core/hindsight.h"
#include "replay_server/core/movement_selector.h"
#include "tests/replay_server/record_script.h"

namespace shoal::replay {

inline constexpr double kDiscount = 0.9;
inline constexpr double kThreshold = 1;

// An observation spec and a sampling method.
struct ReplayCase {
  int stack, n_step;
  std::optional<HindsightGoal> hindsight{};
  bool goal_pictures = false;
  bool end_on_success = false;
  std::optional<double> movement_share{};  // share of samples drawn by remaining motion
  MovementKind movement = MovementKind::kPath;
};

// A task whose goals are points of the plane. The goals of RecordScript are spread over [-2, 2].
inline tasks::Task TinyTask() {
  tasks::Task::Description description;
  description.name = description.world = "Tiny";
  description.episode_length = 10;
  description.achieved_goal = {"achieved_goal", {{"x"}, {"y"}}};
  description.desired_goal = {"desired_goal", {{"x"}, {"y"}}};
  description.reward = tasks::RewardKind::kSparse;
  description.distance_threshold = kThreshold;
  return tasks::Task(description);
}

inline ObservationSpec SpecOf(const ReplayCase& kind) {
  const ObservationSpec spec = TinySpec(kind.stack);
  return kind.goal_pictures ? WithGoalPicture(spec) : spec;
}

}  // namespace shoal::replay
