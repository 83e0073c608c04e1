// SPDX-License-Identifier: Apache-2.0
// Generalised advantages of a rollout.
//
//   delta_t = r_t + discount b_t V(s'_t) - V(s_t)                        Eq. 23
//   A_t     = delta_t + discount lambda c_t A_{t+1},   R_t = A_t + V(s_t)
//
// b is 0 if the task ended in this step, else 1. After a time limit or the end of a rollout, the
// target therefore bootstraps with the value of the next observation. c is 1 if the next row
// continues this row, else 0.
//
// Source: Schulman et al. 2015, arXiv:1506.02438, section 3; time limits: Pardo et al. 2017,
// arXiv:1712.00378. Dimensions: N rows, in the order of common/wire/batch_schema.h.
#pragma once

#include <span>

namespace shoal::learner {

struct AdvantageInputs {
  std::span<const float> reward, bootstrap, continues;  // (N): r, b, c
  std::span<const float> value, next_value;             // (N): V(s), V(s')
  double discount = 1, lambda = 1;
};

// Writes the advantages A and the value targets R, both (N).
void Advantages(const AdvantageInputs& inputs, std::span<float> advantage, std::span<float> target);

// Share of the targets' variance that the values predict: 1 - Var(target - value) / Var(target). 0
// if all targets are equal.
double ExplainedVariance(std::span<const float> value, std::span<const float> target);

}  // namespace shoal::learner
