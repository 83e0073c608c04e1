// SPDX-License-Identifier: Apache-2.0
// Results of a run, finished or not, read from its folder, for comparisons, plots and reports.
// Reads only config.json, meta.json and eval/, so a committed copy without checkpoints is
// sufficient.
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

// The folder without a trailing slash, so that its last part is the name of the run.
std::filesystem::path NamedFolder(const std::filesystem::path& folder);

struct RunResults {
  std::filesystem::path folder{};
  std::string name{};
  Config config{};
  std::vector<EvaluationFigures> curve{};  // evaluations during training, sorted by env steps
  std::vector<RolloutPoint> rollouts{};  // empty until ReadRollouts (launch/tools/report/curves.h)
  std::optional<EvaluationFigures> final{};   // eval/final.json
  std::vector<EvaluationFigures> transfer{};  // eval/on-TASK.json: on other tasks, sorted by task
  // meta.json; empty before the run has written it.
  std::string exit{}, error{}, started{}, finished{}, precision{};
  std::vector<std::string> commits{};  // builds that executed the run, in order
  std::string cpu{};
  int cores = 0;  // cores of the machine that the run may use
  uint64_t env_steps = 0, updates = 0;
  double wall_seconds = 0;
  std::optional<double> cpu_seconds{}, energy_wh{};  // run_meta.h; empty if not counted

  // Value that a tuner maximises: the final success rate, or the final mean return if the task has
  // no success. Empty without a final evaluation.
  std::optional<double> Objective() const;
};

// Throws Error if config.json is missing or a file is broken.
RunResults ReadRunResults(const std::filesystem::path& run);

// Finds the first series of stop.evaluations (two by default) consecutive evaluations whose pooled
// episodes have at least this success rate (launch/record/first_reached.h). Returns the first
// evaluation of the series; null = not reached.
const EvaluationFigures* FirstReaching(const RunResults& run, double success);
// Env steps at the evaluation that FirstReaching returns; empty = not reached.
std::optional<uint64_t> StepsToSuccess(const RunResults& run, double success);

}  // namespace shoal::launch
