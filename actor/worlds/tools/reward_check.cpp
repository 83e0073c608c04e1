// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/reward_check.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "actor/worlds/tools/open_environment.h"
#include "common/base/build_info.h"
#include "common/base/clock.h"
#include "common/base/random.h"
#include "common/tasks/task_registry.h"

namespace shoal::worlds {
namespace {

using tasks::Task;

std::vector<RewardSample> PlaySamples(const Task& task, const RewardCheckRequest& request,
                                      RangeMeter* meter) {
  OpenEnvironment environment(task, request.model);
  std::vector<RewardSample> samples;
  int episode = -1;
  PlayRandomSteps(
      &environment, request.env_steps, request.seed,
      [&] {
        ++episode;
        meter->OnReset(environment.numbers());
      },
      [&](const StepResult& result) {
        meter->OnStep(environment.numbers());
        const auto achieved = environment.achieved_goal(), desired = environment.desired_goal();
        samples.push_back({{achieved.begin(), achieved.end()},
                           {desired.begin(), desired.end()},
                           episode,
                           result});
      });
  return samples;
}

// Implements the documented formulas independently of common/tasks.
double FormulaDistance(std::span<const float> achieved, std::span<const float> desired) {
  double sum = 0;
  for (size_t i = 0; i < achieved.size(); ++i) {
    const double difference = double{achieved[i]} - double{desired[i]};
    sum += difference * difference;
  }
  return std::sqrt(sum);
}

float FormulaReward(const Task& task, double distance) {
  if (task.reward_kind() == tasks::RewardKind::kDense) return -static_cast<float>(distance);
  return distance > task.distance_threshold() ? -1.0f : 0.0f;
}

float ComputedReward(const Task& task, const std::vector<float>& achieved,
                     const std::vector<float>& desired) {
  float reward = 0;
  task.ComputeRewards(achieved, desired, std::span(&reward, 1));
  return reward;
}

void CheckGoals(const Task& task, const std::vector<RewardSample>& samples, RewardCheck* check) {
  for (const RewardSample& sample : samples) {
    const double distance = FormulaDistance(sample.achieved, sample.desired);
    const float computed = ComputedReward(task, sample.achieved, sample.desired);
    check->step_computed += sample.result.reward != computed;
    check->computed_formula += computed != FormulaReward(task, distance);
    check->success_formula += sample.result.success != (distance < task.distance_threshold());
  }
}

// Gives each step the goal that it, or a later step of its episode, achieved. Computes all rewards
// in one call and compares them with the formula.
void CheckRelabelled(const Task& task, const std::vector<RewardSample>& samples, int relabels,
                     int64_t seed, RewardCheck* check) {
  Random draw(StreamKey(static_cast<uint64_t>(seed), StreamRole::kReplaySampler));
  std::vector<float> achieved, desired, formula;
  for (size_t i = 0; i < samples.size(); ++i) {
    size_t end = i;
    while (end < samples.size() && samples[end].episode == samples[i].episode) ++end;
    for (int k = 0; k < relabels; ++k) {
      const RewardSample& later = samples[i + draw.Below(end - i)];
      achieved.insert(achieved.end(), samples[i].achieved.begin(), samples[i].achieved.end());
      desired.insert(desired.end(), later.achieved.begin(), later.achieved.end());
      formula.push_back(FormulaReward(task, FormulaDistance(samples[i].achieved, later.achieved)));
    }
  }
  std::vector<float> computed(formula.size());
  task.ComputeRewards(achieved, desired, computed);
  check->relabelled = static_cast<int>(computed.size());
  for (size_t i = 0; i < computed.size(); ++i) {
    check->relabelled_formula += computed[i] != formula[i];
  }
}

}  // namespace

RewardCheck CompareRewards(const Task& task, const std::vector<RewardSample>& samples, int relabels,
                           int64_t seed) {
  RewardCheck check;
  check.task = task.name();
  check.has_goals = task.goal_size() > 0;
  check.env_steps = static_cast<int>(samples.size());
  check.reward_low = std::numeric_limits<float>::infinity();
  check.reward_high = -check.reward_low;
  for (const RewardSample& sample : samples) {
    check.episodes = sample.episode + 1;
    check.reward_low = std::min(check.reward_low, sample.result.reward);
    check.reward_high = std::max(check.reward_high, sample.result.reward);
    check.reward_sum += sample.result.reward;
    check.successes += sample.result.success;
  }
  if (check.has_goals) {
    CheckGoals(task, samples, &check);
    CheckRelabelled(task, samples, relabels, seed, &check);
  }
  return check;
}

RewardCheck CheckRewards(const RewardCheckRequest& request) {
  const Task& task = tasks::FindTask(request.task);
  RangeMeter meter(task), second(task);
  const std::vector<RewardSample> samples = PlaySamples(task, request, &meter);
  RewardCheck check = CompareRewards(task, samples, request.relabels, request.seed);
  check.constant = ConstantNumbers(task, meter);
  check.observations = meter.observations();
  const std::vector<RewardSample> again = PlaySamples(task, request, &second);
  for (size_t i = 0; i < samples.size(); ++i) {
    check.repeated += samples[i].result.reward != again[i].result.reward;
  }
  return check;
}

nlohmann::ordered_json ToJson(const RewardCheck& check) {
  return {{"schema", "shoal-reward-check-1"},
          {"task", check.task},
          {"has_goals", check.has_goals},
          {"env_steps", check.env_steps},
          {"episodes", check.episodes},
          {"relabelled", check.relabelled},
          {"reward_low", check.reward_low},
          {"reward_high", check.reward_high},
          {"reward_mean", check.reward_sum / static_cast<float>(check.env_steps)},
          {"successes", check.successes},
          {"mismatches",
           {{"step_computed", check.step_computed},
            {"computed_formula", check.computed_formula},
            {"relabelled_formula", check.relabelled_formula},
            {"success_formula", check.success_formula},
            {"repeated", check.repeated}}},
          {"constant_numbers", ToJson(check.constant)},
          {"passed", check.Passed()},
          {"commit", BuildCommit()},
          {"created", UtcTimestamp()}};
}

std::string ToText(const RewardCheck& check) {
  std::string text =
      fmt::format("{}: {} random env steps, {} episodes, rewards {:.4f} .. {:.4f}\n", check.task,
                  check.env_steps, check.episodes, check.reward_low, check.reward_high);
  const auto line = [&](const char* what, int mismatches, int of) {
    text += fmt::format("  {:<46} {:>5} mismatches of {}\n", what, mismatches, of);
  };
  if (check.has_goals) {
    line("step's reward = goal half's", check.step_computed, check.env_steps);
    line("goal half's reward = formula", check.computed_formula, check.env_steps);
    line("goal half's reward = formula, relabelled goals", check.relabelled_formula,
         check.relabelled);
    line("step's success = distance below the threshold", check.success_formula, check.env_steps);
  } else {
    text += "  no goals: the physics half gives the reward, nothing recomputes it\n";
  }
  line("step's reward = that of a second rollout", check.repeated, check.env_steps);
  text += ToText(check.constant, check.observations);
  return text + (check.Passed() ? "passed\n" : "FAILED\n");
}

}  // namespace shoal::worlds
