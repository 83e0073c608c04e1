// SPDX-License-Identifier: Apache-2.0
// The description of an environment that is not one of Shoal's worlds: its observation, its action
// and how its episodes end. environment_description.h converts the description to and from JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/tasks/task.h"

namespace shoal::tasks {

inline constexpr char kAchievedGoal[] = "achieved_goal", kDesiredGoal[] = "desired_goal";

// Types of elements that an environment's arrays may have.
enum class ElementType {
  kFloat32,
  kFloat64,
  kUint8,
  kUint16,
  kUint32,
  kInt8,
  kInt16,
  kInt32,
  kInt64
};

// One array of an observation, or the action: a Box in Gymnasium's terms.
struct ArraySpace {
  std::string name;  // keys of nested Dicts joined by dots: "robot.arm"
  std::vector<int> shape;
  ElementType type = ElementType::kFloat32;
  std::vector<double> low{},
      high{};  // one number for each element, or one for all; may be infinite

  int size() const;
  double Low(int element) const;
  double High(int element) const;
  bool operator==(const ArraySpace&) const = default;
};

// Reward of a goal environment that Shoal can compute for other goals too.
struct VerifiedGoal {
  RewardKind reward = RewardKind::kSparse;
  double threshold = 0;

  bool operator==(const VerifiedGoal&) const = default;
};

struct EnvironmentDescription {
  std::string id;         // value of env.id: "Pendulum-v1", "/home/me/my_env.py:MyEnv"
  std::string task;       // name of the task in Shoal
  int episode_steps = 0;  // 0 = no time limit
  ArraySpace action;
  std::vector<ArraySpace> observation;
  bool success = false;                // whether steps report success
  std::optional<VerifiedGoal> goal{};  // empty unless Shoal can compute the rewards
  std::string no_goal{};               // reason why `goal` is empty; empty if there are no goals

  const ArraySpace* Find(const std::string& name) const;
  // Copies from `of` the members that are known only after the environment was played or checked:
  // success, goal, no_goal.
  void TakeFindings(const EnvironmentDescription& of);
  bool operator==(const EnvironmentDescription&) const = default;
};

}  // namespace shoal::tasks
