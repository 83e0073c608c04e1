// SPDX-License-Identifier: Apache-2.0
// Metrics of a batch's transitions, and of the critics' values for these transitions, for every
// algorithm. TensorBoard shows these metrics below replay/.
#pragma once

#include "common/spec/observation_spec.h"
#include "common/wire/batch_schema.h"
#include "learner/agent/update_figures.h"

namespace shoal::learner {

// Metrics of the sampled rewards, unscaled. The reward of an n-step sample is the sum of its
// rewards.
inline constexpr Figure kRewardMean{"reward_mean", "", "mean of sampled rewards", false,
                                    "replay/reward_mean"};
inline constexpr Figure kRewardStd{"reward_std", "", "standard deviation of sampled rewards", false,
                                   "replay/reward_std"};
inline constexpr Figure kRewardMin{"reward_min", "", "smallest sampled reward", false,
                                   "replay/reward_min"};
inline constexpr Figure kRewardMax{"reward_max", "", "largest sampled reward", false,
                                   "replay/reward_max"};
inline constexpr Figure kRewardAboveMinusHalf{
    "reward_above_minus_half", "",
    "share of sampled rewards above -0.5; in a sparse task, the share of samples at the goal",
    false, "replay/reward_above_minus_half"};
// The metrics of goals exist if the policy observes the achieved and the desired goal.
inline constexpr Figure kGoalDistanceMean{
    "goal_distance_mean", "m",
    "mean distance between achieved and desired goals of samples; observation.goal_mode = both",
    false, "replay/goal_distance_mean"};
inline constexpr Figure kGoalDistanceStd{"goal_distance_std", "m",
                                         "standard deviation of goal distances", false,
                                         "replay/goal_distance_std"};
inline constexpr Figure kGoalDistanceMin{"goal_distance_min", "m", "smallest goal distance", false,
                                         "replay/goal_distance_min"};
inline constexpr Figure kGoalDistanceMax{"goal_distance_max", "m", "largest goal distance", false,
                                         "replay/goal_distance_max"};
inline constexpr Figure kGoalWithin{"goal_within", "", "share of goal distances below 0.05 m",
                                    false, "replay/goal_within_threshold"};
inline constexpr const Figure* kSampleFigures[] = {
    &kRewardMean,           &kRewardStd,        &kRewardMin,       &kRewardMax,
    &kRewardAboveMinusHalf, &kGoalDistanceMean, &kGoalDistanceStd, &kGoalDistanceMin,
    &kGoalDistanceMax,      &kGoalWithin};

// Appends the metrics above that exist for `batch`, which must not be normalised. Appends no metric
// for a rollout.
void AddSampleFigures(const BatchView& batch, const ObservationSpec& spec, UpdateFigures* figures);

// Metrics of the Q functions before an update, at the sampled actions.
inline constexpr Figure kQ1Mean{"q1_mean", "", "mean of the first Q function", false,
                                "replay/q1_mean"};
inline constexpr Figure kQ1Std{"q1_std", "", "standard deviation of the first Q function", false,
                               "replay/q1_std"};
inline constexpr Figure kQ2Mean{"q2_mean", "", "mean of the second Q function, if there is one",
                                false, "replay/q2_mean"};
inline constexpr Figure kQ2Std{"q2_std", "", "standard deviation of the second Q function", false,
                               "replay/q2_std"};
inline constexpr Figure kQMinMean{"q_min_mean", "", "mean of the smallest Q", false,
                                  "replay/q_min_mean"};
inline constexpr Figure kQMinStd{"q_min_std", "", "standard deviation of the smallest Q", false,
                                 "replay/q_min_std"};
inline constexpr Figure kQMinMin{"q_min_min", "", "smallest value of the smallest Q", false,
                                 "replay/q_min_min"};
inline constexpr Figure kQMinMax{"q_min_max", "", "largest value of the smallest Q", false,
                                 "replay/q_min_max"};

}  // namespace shoal::learner
