// SPDX-License-Identifier: Apache-2.0
// The means of one evaluation, for comparisons, plots and baselines.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace shoal::launch {

struct EvaluationFigures {
  uint64_t env_steps = 0, updates = 0;
  double wall_seconds = 0;  // since the run's start
  std::string task{}, checkpoint{};
  size_t episodes = 0;
  std::optional<double> success{};  // rate; empty if the task has no success
  double return_mean = 0, return_std = 0;
  std::optional<double> final_distance_mean{};  // m; empty if the task has no goals
};

// Throws Error unless the file is a shoal-eval-1 object.
EvaluationFigures ReadEvaluationFigures(const std::filesystem::path& file);

}  // namespace shoal::launch
