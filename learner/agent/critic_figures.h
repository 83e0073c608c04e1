// SPDX-License-Identifier: Apache-2.0
// Figures of a critic's loss over a whole batch, combined from the replicas' rows.
#pragma once

#include <span>

#include "common/nn/replica.h"
#include "learner/agent/update_figures.h"

namespace shoal::learner {

// q_i of one Q function or more and targets y, each (b) of the replica's rows: shown to the other
// replicas with the next Adam::GatherGradients.
void PostCriticValues(nn::Replica* replica, std::span<const float* const> q,
                      std::span<const float> y);

// After that. gradient_squares: its result. Sets the figures from the critic's loss to
// AddValueFigures and returns the loss; both are those of the whole batch in all replicas.
float SetCriticFigures(const nn::Replica& replica, double gradient_squares, UpdateFigures* figures);

}  // namespace shoal::learner
