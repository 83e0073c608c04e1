// SPDX-License-Identifier: Apache-2.0
// Results of a run, finished or not, read from its folder: the figures of comparisons, plots and
// reports. Reads config.json, meta.json and eval/ alone, so that a committed copy without
// checkpoints serves as well.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/config/config.h"
#include "launch/record/evaluation_figures.h"
#include "launch/record/rollout_curve.h"

namespace shoal::launch {

// The folder without a slash at its end, which typing it often leaves: its last part is its name.
std::filesystem::path NamedFolder(const std::filesystem::path& folder);

struct RunResults {
  std::filesystem::path folder{};
  std::string name{};
  Config config{};
  std::vector<EvaluationFigures> curve{};  // while training, by env steps
  std::vector<RolloutPoint> rollouts{};  // empty until ReadRollouts (launch/tools/report/curves.h)
  std::optional<EvaluationFigures> final{};   // eval/final.json
  std::vector<EvaluationFigures> transfer{};  // eval/on-TASK.json: on other tasks, by task
  // meta.json; empty before the run has written it.
  std::string exit{}, error{}, started{}, finished{}, precision{};
  std::vector<std::string> commits{};  // builds that took part, in order
  std::string cpu{};
  int cores = 0;  // of the machine that it could use
  uint64_t env_steps = 0, updates = 0;
  double wall_seconds = 0;

  // The figure that a tuner maximises: the final success rate, or the final mean return if the task
  // has no success; empty without a final evaluation.
  std::optional<double> Objective() const;
};

// Throws Error: no config.json, or a broken file.
RunResults ReadRunResults(const std::filesystem::path& run);

// The first of the first stop.evaluations (two by default) evaluations in a row whose episodes,
// pooled, have at least this success (launch/record/first_reached.h); null = not reached.
const EvaluationFigures* FirstReaching(const RunResults& run, double success);
// The env steps at that one; empty = not reached.
std::optional<uint64_t> StepsToSuccess(const RunResults& run, double success);

}  // namespace shoal::launch
