// SPDX-License-Identifier: Apache-2.0
// The goal half of a task: the parts of an observation, the reward, the condition for a reached
// goal, and the length of an episode. The goal half consists of data and arithmetic, without
// physics. The actor uses the goal half to compute the rewards of steps, and the replay uses it to
// compute rewards for other goals. The physics half of the same name is in actor/worlds.
//
// A task without goals (goal_size() == 0) describes only its observation, its action and its
// episodes. The physics half then computes reward and termination, and the task has no distance.
//
// A *control step* is one step of the task as published. An env step repeats one action for
// `action_repeat` control steps.
//
// Dimension letters: N goals in a batch, G numbers of a goal.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

namespace shoal::tasks {

// One number of a block or an action.
struct Component {
  std::string name;          // "grip_x"
  std::string unit = "";     // "m"; empty = dimensionless
  std::string meaning = "";  // one line, for people
  // Bounds in `unit`, both included; infinite if the task sets no bounds.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

// One named vector of an observation.
struct Block {
  std::string name;  // "grip", "observation", "achieved_goal", "desired_goal"
  std::vector<Component> components;

  int size() const { return static_cast<int>(components.size()); }
};

// episode_length of a task whose episodes have no time limit or an unknown time limit.
inline constexpr int kNoTimeLimit = 1'000'000'000;

enum class RewardKind {
  kSparse,  // -1 while the distance exceeds the threshold, else 0
  kDense,   // -distance
};

class Task {
 public:
  struct Description {
    std::string name;                // "FetchReachDense"
    std::string world;               // name of the physics half: "FetchReach"
    int episode_length = 0;          // control steps after which an episode is truncated
    int action_repeat = 1;           // control steps of an env step, unless configured otherwise
    std::vector<Component> action;   // each in [-1, 1]
    std::vector<Block> observation;  // the state vector, block by block, in the published order
    Block achieved_goal;             // G components in units of length
    Block desired_goal;              // the same G components
    RewardKind reward = RewardKind::kSparse;
    double distance_threshold = 0;  // m
    std::string physics_reward;     // without goals: the physics half's reward in words
    bool reports_success = false;   // without goals: whether steps report success
    std::string no_goals;           // why Shoal cannot use the task's goals; empty: it has no goals
  };

  // Throws Error (kUsage), in one line, if the description is invalid (common/tasks/task_check.h).
  explicit Task(Description description);

  // The same task with another distance_threshold (m). Throws Error (kUsage) if the task has no
  // goals.
  Task WithThreshold(double metres) const;

  const std::string& name() const { return description_.name; }
  const std::string& world() const { return description_.world; }
  int episode_length() const { return description_.episode_length; }
  int action_repeat() const { return description_.action_repeat; }
  // The action repeat of a run that requests `asked`; 0 requests the task's own.
  int ActionRepeat(int asked) const { return asked > 0 ? asked : action_repeat(); }
  // Env steps after which an episode is truncated: ceil(episode_length / repeat). The last env step
  // may have fewer control steps.
  int EnvStepsPerEpisode(int repeat) const;
  const std::vector<Component>& action() const { return description_.action; }
  int action_size() const { return static_cast<int>(description_.action.size()); }
  // The whole state vector, in the published order, as one block with the name "observation".
  const Block& observation() const { return observation_; }
  // The blocks of the state vector. Records contain these blocks, and a policy may observe some of
  // them.
  const std::vector<Block>& state_blocks() const { return description_.observation; }
  const Block& achieved_goal() const { return description_.achieved_goal; }
  const Block& desired_goal() const { return description_.desired_goal; }
  int goal_size() const { return description_.desired_goal.size(); }
  // Whether the episodes of this task succeed or fail. Most tasks without goals only have a return.
  bool has_success() const { return goal_size() > 0 || description_.reports_success; }
  RewardKind reward_kind() const { return description_.reward; }
  double distance_threshold() const { return description_.distance_threshold; }
  const std::string& physics_reward() const { return description_.physics_reward; }
  const std::string& no_goals() const { return description_.no_goals; }

  // The functions below CHECK that the task has goals.
  //
  // Goals are the float32 numbers in the records. Therefore the actor and the replay compute the
  // same reward for a record, to the last bit. Sums are computed in double.

  // Euclidean distance in m between two goals (G each).
  double Distance(std::span<const float> achieved, std::span<const float> desired) const;
  // Whether the distance is strictly below the threshold.
  bool Success(double distance) const { return distance < description_.distance_threshold; }
  // Reward at this distance, unscaled.
  float Reward(double distance) const;
  // reward[i] = Reward(Distance(achieved[i], desired[i])) for N goals: achieved, desired (N, G)
  // row-major, reward (N). CHECKs that the sizes agree.
  void ComputeRewards(std::span<const float> achieved, std::span<const float> desired,
                      std::span<float> reward) const;

 private:
  Description description_;
  Block observation_;
};

}  // namespace shoal::tasks
