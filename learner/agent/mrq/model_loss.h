// SPDX-License-Identifier: Apache-2.0
// The loss of a latent model over a sequence of steps (Eq. 37 of docs/algorithm.md). The functions
// work on arrays in host memory.
//
// Step h has a number p_h (1 if it is present), an end e_h, a reward r_h and a target state z_h.
// The model predicts e^_h, z^_h, and the logits l_h of the reward:
//
//   L = mean_b sum_h p_h (mean_i (z^_hi - z_hi)^2 + w_r CE(l_h, two_hot(r_h)) + w_e (e^_h - e_h)^2)
//
// two_hot divides the weight 1 between the two bins around r, so that the mean of the bins is r.
// The bins are symexp(x) = sign(x) (exp |x| - 1) for R numbers x, evenly spaced in [-10, 10].
//
// Dimensions: b rows, Z numbers of a state, R bins (nn::kRewardBins). Source: Fujimoto et al. 2025,
// arXiv:2501.16142, section 4.2.1 and appendix B.
#pragma once

#include <span>
#include <vector>

#include "common/nn/latent_plan.h"

namespace shoal::learner {

// The bins in ascending order (R).
const std::vector<double>& RewardBins();

// The two bins around a reward: `low` and the next one, and the weight of the next one. A reward
// beyond the first or the last bin belongs to this bin alone.
struct TwoHot {
  int low = 0;
  double weight_of_next = 0;
};
TwoHot TwoHotOf(double reward);

// Arrays of one step.
struct ModelStep {
  std::span<const float> end, state, reward_logits;    // predictions: (b), (b, Z), (b, R)
  std::span<const float> target_state;                 // (b, Z)
  std::span<const float> reward, terminated, present;  // (b)
};
struct ModelStepGradients {
  std::span<float> end, state, reward_logits;  // dL/d(prediction)
};
// Terms of the loss for each row (b), summed over the steps and without the weights w.
struct ModelRowLosses {
  std::span<float> state, reward, end;
};
struct ModelLossWeights {
  double reward = 0.1, end = 0.1;
};

// Writes the gradients of L for one step, and adds its terms to `losses`.
void AddModelLoss(const ModelStep& step, const ModelLossWeights& weights,
                  const ModelStepGradients& gradients, const ModelRowLosses& losses);

}  // namespace shoal::learner
