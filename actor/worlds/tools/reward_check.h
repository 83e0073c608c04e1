// SPDX-License-Identifier: Apache-2.0
// Check of a task's rewards. Plays random actions and compares three rewards for each step: the
// reward of the step, the goal half's reward for the goals of the step's record, and the reward by
// the documented formula. Then compares the last two rewards for substituted goals, as in
// hindsight.
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
  std::string model = "";  // path of another MJCF file; empty = the built-in model
  int env_steps = 500;
  int relabels = 4;  // other goals per step: achieved goals of later steps of the episode
  int64_t seed = 1;
};

// Result of the check. All comparisons test float32 numbers for equality. For tasks without goals
// only `repeated` is computed.
struct RewardCheck {
  std::string task;
  bool has_goals = false;
  int env_steps = 0, episodes = 0;
  int relabelled = 0;  // rewards computed for other goals
  float reward_low = 0, reward_high = 0, reward_sum = 0;
  int successes = 0;  // steps that ended in success
  // Numbers of mismatches between the two named rewards or flags:
  int step_computed = 0;       // step's reward, goal half's reward
  int computed_formula = 0;    // goal half's reward, formula's reward
  int relabelled_formula = 0;  // the same for substituted goals
  int success_formula = 0;     // step's success flag, distance < threshold
  int repeated = 0;            // step's reward, the same step of a second rollout
  // Numbers that never changed (a warning, not a mismatch), and the number of observations.
  std::vector<ConstantNumber> constant{};
  int observations = 0;

  bool Passed() const {
    return step_computed + computed_formula + relabelled_formula + success_formula + repeated == 0;
  }
};

// Goals of one step, from the step's record, and the result of the step.
struct RewardSample {
  std::vector<float> achieved, desired;
  int episode = 0;  // number of the episode within the samples
  StepResult result;
};

// Computes everything except `repeated` from played samples. `relabels`: see RewardCheckRequest.
RewardCheck CompareRewards(const tasks::Task& task, const std::vector<RewardSample>& samples,
                           int relabels, int64_t seed);

// Runs the check. Throws Error (kUsage) on an unknown task; the message lists the known tasks.
RewardCheck CheckRewards(const RewardCheckRequest& request);

// Schema shoal-reward-check-1.
nlohmann::ordered_json ToJson(const RewardCheck& check);
// The result as text, with the verdict last.
std::string ToText(const RewardCheck& check);

}  // namespace shoal::worlds
