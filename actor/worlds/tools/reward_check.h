// SPDX-License-Identifier: Apache-2.0
// Are the rewards of a task what they are said to be? Plays random actions and compares, number by
// number: the reward of each step, what the goal half computes for the goals of its record, and the
// written formula; then the last two again for goals that were put in later, as hindsight does.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "actor/worlds/environment.h"
#include "actor/worlds/tools/measured_ranges.h"
#include "common/tasks/task.h"

namespace shoal::worlds {

struct RewardCheckRequest {
  std::string task;
  std::string model = "";  // path of another MJCF file; empty = our own
  int env_steps = 500;
  int relabels = 4;  // other goals per step: achieved ones of later steps of its episode
  int64_t seed = 1;
};

// Every comparison is for equality of float32 numbers. Tasks without goals have only `repeated`.
struct RewardCheck {
  std::string task;
  bool has_goals = false;
  int env_steps = 0, episodes = 0;
  int relabelled = 0;  // rewards computed for other goals
  float reward_low = 0, reward_high = 0, reward_sum = 0;
  int successes = 0;  // steps that ended in success
  // Mismatches:
  int step_computed = 0;     // step's reward, goal half
  int computed_formula = 0;  // goal half, formula
  int relabelled_formula = 0;
  int success_formula = 0;  // step's success flag, distance < threshold
  int repeated = 0;         // step's reward, the same step of a second rollout
  // A warning, no mismatch: numbers that never changed, in so many observations.
  std::vector<ConstantNumber> constant{};
  int observations = 0;

  bool Passed() const {
    return step_computed + computed_formula + relabelled_formula + success_formula + repeated == 0;
  }
};

// Goals of one step as its record carries them, and what the step gave.
struct RewardSample {
  std::vector<float> achieved, desired;
  int episode = 0;  // of the samples, in order
  StepResult result;
};

// Everything but `repeated`, over samples that were played; see RewardCheckRequest for `relabels`.
RewardCheck CompareRewards(const tasks::Task& task, const std::vector<RewardSample>& samples,
                           int relabels, int64_t seed);

// Throws Error (kUsage) on an unknown task, listing those there are.
RewardCheck CheckRewards(const RewardCheckRequest& request);

// Schema shoal-reward-check-1.
nlohmann::ordered_json ToJson(const RewardCheck& check);
// For people, the verdict last.
std::string ToText(const RewardCheck& check);

}  // namespace shoal::worlds
