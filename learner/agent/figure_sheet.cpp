// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/figure_sheet.h"

#include <cmath>

#include "learner/agent/sample_figures.h"

namespace shoal::learner {

void FigureSheet::SetCritic(const CriticNumbers& numbers, Number gradient_squares) {
  Set(kCriticLoss, numbers.loss);
  Set(kQMean, numbers.q_mean);
  Set(kTargetMean, numbers.target_mean);
  SetRoot(kCriticGradNorm, gradient_squares);
  Set(kQ1Mean, numbers.q1_mean);
  Set(kQ1Std, numbers.q1_std);
  if (numbers.q2_mean) {
    Set(kQ2Mean, numbers.q2_mean);
    Set(kQ2Std, numbers.q2_std);
  }
  Set(kQMinMean, numbers.q_min_mean);
  Set(kQMinStd, numbers.q_min_std);
  Set(kQMinMin, numbers.q_min_min);
  Set(kQMinMax, numbers.q_min_max);
}

UpdateFigures FigureSheet::Read(const Engine& engine, const Engine::Outcome& outcome) const {
  UpdateFigures figures;
  if (!outcome.batch_finite) return figures;
  for (const Entry& entry : entries_) {
    const double value = entry.number ? engine.Read(entry.number) : entry.value;
    figures.Set(*entry.figure, entry.root ? std::sqrt(value) : value);
  }
  return figures;
}

CriticNumbers NewCriticNumbers(int critics, Engine* engine) {
  const auto number = [engine] { return engine->NewNumber(); };
  CriticNumbers numbers{.loss = number(),
                        .q_mean = number(),
                        .target_mean = number(),
                        .q1_mean = number(),
                        .q1_std = number(),
                        .q2_mean = {},
                        .q2_std = {},
                        .q_min_mean = number(),
                        .q_min_std = number(),
                        .q_min_min = number(),
                        .q_min_max = number()};
  if (critics > 1) {
    numbers.q2_mean = number();
    numbers.q2_std = number();
  }
  return numbers;
}

}  // namespace shoal::learner
