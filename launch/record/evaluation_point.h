// SPDX-License-Identifier: Apache-2.0
// The results of one evaluation, for meta.json, the stop rule and the display.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace shoal::launch {

struct EvaluationPoint {
  uint64_t env_steps = 0, updates = 0;
  double wall_seconds = 0;                 // since the run's start
  std::optional<double> success;           // rate, 0..1; empty if the task defines no success
  double mean_return = 0;                  // unscaled
  std::optional<double> return_std{};      // standard deviation of the episodes' returns
  double mean_length = 0;                  // env steps
  std::optional<double> final_distance{};  // mean at the episodes' ends, m; empty without goals
  std::string checkpoint{};                // folder name under checkpoints/
  size_t episodes = 0;                     // number of episodes played
  uint64_t learner_session = 0;            // session whose parameters were evaluated
  size_t faulty_episodes = 0;              // included in `episodes`; they count as failed
};

// "success 98.0 % of 50 episodes, return -0.970 +- 0.120". For a task without success: "return
// 312.500 +- 8.100, length 740.2, 50 episodes". Unknown numbers are left out. The number after +-
// is the standard deviation of the episodes' returns. If some episodes were faulty, the text ends
// with ", 2 faulty episodes".
std::string FormatScore(const EvaluationPoint& point);
// The text of FormatScore. For a task with success, mean length and final distance are appended: ",
// length 50.0, final distance 0.021 m".
std::string FormatWholeScore(const EvaluationPoint& point);

}  // namespace shoal::launch
