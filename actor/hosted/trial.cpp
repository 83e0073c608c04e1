// SPDX-License-Identifier: Apache-2.0
#include "actor/hosted/trial.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <vector>

#include "actor/hosted/element_conversion.h"
#include "common/base/clock.h"
#include "common/base/random.h"

namespace shoal::hosted {
namespace {

constexpr std::chrono::seconds kTrial{2};
constexpr size_t kMostTrialSteps = 1000, kRepeatedSteps = 50;

constexpr double kRewardTolerance = 1e-4;  // relative, of rewards and of the threshold

// One episode: hashes of the first observation, then of each step.
struct Played {
  std::vector<uint64_t> moments;
  bool success = false;        // a step reported whether it succeeded
  std::string other_reward{};  // first reward that differs from the goal's
};

// Compares rewards with those that the replay computes from the goals.
class GoalRewards {
 public:
  explicit GoalRewards(const tasks::EnvironmentDescription& description)
      : description_(description), task_(TaskOf(description)) {}

  // Empty if the reward is right, or if the distance is too near the threshold to judge.
  std::string Fault(const RawEnvironment& environment, double reward, size_t step) const {
    if (!description_.goal) return "";
    const double distance = task_.Distance(Goal(environment, tasks::kAchievedGoal),
                                           Goal(environment, tasks::kDesiredGoal));
    const double threshold = description_.goal->threshold;
    const bool near = std::abs(distance - threshold) <= kRewardTolerance * threshold;
    const double expected = task_.Reward(distance);
    if (near || std::abs(reward - expected) <= kRewardTolerance * (1 + std::abs(expected)))
      return "";
    return fmt::format("the reward of step {} is {:g}, where a distance of {:g} gives {:g}", step,
                       reward, distance, expected);
  }

 private:
  std::vector<float> Goal(const RawEnvironment& environment, const char* name) const {
    const tasks::ArraySpace* space = description_.Find(name);
    const auto array = size_t(space - description_.observation.data());
    return ToFloats(space->type, environment.observation()[array], size_t(space->size()));
  }

  const tasks::EnvironmentDescription& description_;
  const tasks::Task task_;
};

uint64_t HashOf(const RawEnvironment& environment,
                const tasks::EnvironmentDescription& description) {
  uint64_t hash = 0;
  for (size_t i = 0; i < description.observation.size(); ++i) {
    const tasks::ArraySpace& space = description.observation[i];
    const size_t bytes = size_t(space.size()) * tasks::BytesOf(space.type);
    hash = HashWords({hash, HashBytes(environment.observation()[i], bytes)});
  }
  return hash;
}

// Plays random actions of a seed until the episode ends, `most` moments are played or `end` is
// reached.
Played Play(RawEnvironment& environment, const tasks::EnvironmentDescription& description,
            uint64_t seed, size_t most, SteadyTime end) {
  const GoalRewards rewards(description);
  Random random(seed);
  environment.Reset(uint32_t(seed & 0x7fffffffU));
  Played played{.moments = {HashOf(environment, description)}};
  std::vector<double> action(size_t(description.action.size()));
  while (played.moments.size() < most && Now() < end) {
    for (size_t i = 0; i < action.size(); ++i) {
      const double low = description.action.Low(int(i)), high = description.action.High(int(i));
      action[i] = low + random.Uniform() * (high - low);
    }
    const RawStep step = environment.Step(action);
    played.success = played.success || step.success.has_value();
    if (played.other_reward.empty()) {
      played.other_reward = rewards.Fault(environment, step.reward, played.moments.size());
    }
    played.moments.push_back(
        HashWords({HashOf(environment, description), std::bit_cast<uint64_t>(step.reward),
                   uint64_t{step.terminated}, uint64_t{step.truncated}}));
    if (step.terminated || step.truncated) break;
  }
  return played;
}

}  // namespace

Trial TryEnvironment(RawEnvironment& environment, const tasks::EnvironmentDescription& description,
                     uint64_t seed) {
  const SteadyTime start = Now();
  const Played first = Play(environment, description, seed, kMostTrialSteps, start + kTrial);
  const std::chrono::duration<double> seconds = Now() - start;
  const auto count = std::min(first.moments.size(), kRepeatedSteps);
  const Played again = Play(environment, description, seed, count, Now() + 2 * kTrial);
  const size_t steps = first.moments.size() - 1;
  Trial trial{.steps = int(steps),
              .step_microseconds = 1e6 * seconds.count() / double(std::max<size_t>(1, steps)),
              .success = first.success,
              .repeated_steps = int(again.moments.size()) - 1,
              .differs_at = {},
              .other_reward = first.other_reward};
  const auto [was, is] = std::ranges::mismatch(first.moments, again.moments);
  if (is != again.moments.end()) trial.differs_at = int(is - again.moments.begin());
  return trial;
}

}  // namespace shoal::hosted
