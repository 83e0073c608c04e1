// SPDX-License-Identifier: Apache-2.0
// Description of a task, as text and JSON: its numbers with units, meaning and bounds, the effects
// of its actions, its reward and its cameras. The task's goal half declares most of this; ranges
// and effects of actions are measured in the task's physics half.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "actor/worlds/camera_view.h"
#include "actor/worlds/tools/measured_ranges.h"
#include "common/tasks/task.h"

namespace shoal::worlds {

// The effect of one action component. `change`: each number of the state vector after `env_steps`
// steps in which only component `axis` acts, with value `command`, minus the number after as many
// steps of zero action from the same start.
struct AxisProbe {
  int axis = 0;
  double command = 0;  // -1 or 1
  int env_steps = 0;   // fewer than requested if the episode ended
  std::vector<double> change;
};

struct TaskDescription {
  const tasks::Task* task = nullptr;
  double env_step_seconds = 0;  // simulated, with the task's own action repeat
  std::string fingerprint;      // model fingerprint
  std::vector<CameraView> cameras;
  int random_env_steps = 0;  // env steps in which the ranges were measured
  // One per number of the observation, the achieved and the desired goal.
  std::vector<MeasuredRange> observation, achieved_goal, desired_goal;
  std::vector<ConstantNumber> constant;  // numbers that never changed
  int observations = 0;                  // observations in which the ranges were measured
  std::vector<AxisProbe> probes;         // two per axis: -1, then 1
};

struct DescribeRequest {
  std::string task;
  std::string model = "";      // path of another MJCF file; empty = the built-in model
  int probe_env_steps = 5;     // env steps per command
  int random_env_steps = 500;  // env steps of uniform random actions, in any number of episodes
  int64_t seed = 1;
};

// Describes a task. Throws Error (kUsage) on an unknown task; the message lists the known tasks.
TaskDescription DescribeTask(const DescribeRequest& request);

// Schema shoal-env-1. Infinite bounds are null.
nlohmann::ordered_json ToJson(const TaskDescription& description);
// The description as text.
std::string ToText(const TaskDescription& description);

}  // namespace shoal::worlds
