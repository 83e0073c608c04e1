// SPDX-License-Identifier: Apache-2.0
// Generalised advantages of a rollout.
//
//   delta_t = r_t + discount b_t V(s'_t) - V(s_t)                        Eq. 23
//   A_t     = delta_t + discount lambda c_t A_{t+1},   R_t = A_t + V(s_t)
//
// b: 0 where the task ended, else 1: a time limit and a rollout's end are bootstrapped by the value
// of the observation that they led to. c: 1 where the next row goes on from this one.
// Source: Schulman et al. 2015, arXiv:1506.02438, section 3; time limits: Pardo et al. 2017,
// arXiv:1712.00378. Dimensions: N rows, in the order of wire/batch_schema.h.
#pragma once

#include <span>

namespace shoal::learner {

struct AdvantageInputs {
  std::span<const float> reward, bootstrap, continues;  // (N): r, b, c
  std::span<const float> value, next_value;             // (N): V(s), V(s')
  double discount = 1, lambda = 1;
};

// advantage, target (N): A, R.
void Advantages(const AdvantageInputs& inputs, std::span<float> advantage, std::span<float> target);

// 1 - Var(target - value) / Var(target), 0 where the targets are all alike: how much of the returns
// the values foretold.
double ExplainedVariance(std::span<const float> value, std::span<const float> target);

}  // namespace shoal::learner
