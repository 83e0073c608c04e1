// SPDX-License-Identifier: Apache-2.0
// Prioritised sampling in the critic's loss (Eq. 34 of docs/algorithm.md): importance weights of a
// batch, or Huber's function of the errors.
//
//   proportional:  w_i = (min_j P_j / P_i)^b,  which is (n P_i)^-b divided by its largest value
//
// P_i: probability of the draw of row i; n: number of samples that could be drawn; b:
// replay.priority_correction.
#pragma once

#include <span>
#include <vector>

#include "common/config/config.h"
#include "common/wire/batch_schema.h"
#include "learner/agent/figure_sheet.h"
#include "learner/agent/update_figures.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

inline constexpr Figure kImportanceWeight{
    "importance_weight", "",
    "mean importance weight of a batch's rows; replay.priorities = proportional", false, ""};

std::vector<float> ImportanceWeights(std::span<const float> probabilities, double exponent);

// Makes the CriticRows of each batch. One thread.
class CriticRowsMaker {
 public:
  // Borrows the engine.
  CriticRowsMaker(const ReplayConfig& replay, Engine* engine) : replay_(replay), engine_(engine) {}

  // Within an update: the rows of the whole batch `drawn`, valid until the update ends. Adds the
  // mean weight to the figures, if there are weights.
  CriticRows Of(const BatchView& drawn, FigureSheet* figures);

 private:
  const ReplayConfig replay_;
  Engine* const engine_;
  // (B), borrowed by the engine until the update ends. The memory is the same in each update,
  // because an engine may repeat a recording of its operations.
  std::vector<float> weights_;
};

}  // namespace shoal::learner
