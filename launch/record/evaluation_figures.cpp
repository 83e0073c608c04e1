// SPDX-License-Identifier: Apache-2.0
#include "launch/record/evaluation_figures.h"

#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/run_folder/evaluation_file.h"

namespace shoal::launch {
namespace {

EvaluationFigures FiguresOf(const EvaluationSummary& summary, const std::string& source) {
  const EvaluationAggregate& aggregate = summary.aggregate;
  if (!aggregate.return_std) throw RuntimeError("{}: no 'aggregate.return_std'", source);
  return {.env_steps = summary.env_steps,
          .updates = summary.version ? summary.version->update : 0,
          .wall_seconds = summary.wall_seconds,
          .task = summary.task,
          .checkpoint = summary.checkpoint.value_or(""),
          .episodes = aggregate.episodes,
          .success = aggregate.success_rate,
          .return_mean = aggregate.return_mean,
          .return_std = *aggregate.return_std,
          .final_distance_mean = aggregate.final_distance_mean};
}

}  // namespace

EvaluationFigures ReadEvaluationFigures(const std::filesystem::path& file) {
  return FiguresOf(SummaryOf(ParseEvaluationObject(ReadFile(file), file), file), file);
}

}  // namespace shoal::launch
