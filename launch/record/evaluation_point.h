// SPDX-License-Identifier: Apache-2.0
// The figures of one evaluation, as meta.json, the stop rule and the display use them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace shoal::launch {

struct EvaluationPoint {
  uint64_t env_steps = 0, updates = 0;
  double wall_seconds = 0;             // since the run's start
  std::optional<double> success;       // rate, 0..1; empty where the task has no success of its own
  double mean_return = 0;              // unscaled
  std::optional<double> return_std{};  // standard deviation of the episodes' returns
  double mean_length = 0;              // env steps
  std::optional<double> final_distance{};  // mean at the episodes' ends, m; of tasks with goals
  std::string checkpoint{};                // folder name under checkpoints/
  size_t episodes = 0;                     // played
  uint64_t learner_session = 0;            // whose parameters were evaluated
  size_t faulty_episodes = 0;              // of those played; they have failed
};

// "success 98.0 % of 50 episodes, return -0.970 +- 0.120", with what is known; where there is no
// success "return 312.500 +- 8.100, length 740.2, 50 episodes". After +- stands the standard
// deviation of the episodes' returns. Where there are some: ", 2 faulty episodes".
std::string FormatScore(const EvaluationPoint& point);
// The same, with the mean length and final distance behind it that it leaves out of a task with
// success: ", length 50.0, final distance 0.021 m".
std::string FormatWholeScore(const EvaluationPoint& point);

}  // namespace shoal::launch
