// SPDX-License-Identifier: Apache-2.0
#include "learner/engine/clipped_policy_loss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "common/base/random.h"

namespace shoal::learner {
namespace {

// The gradients of the loss against central differences, ratios inside and beyond the clip.
TEST(ClippedPolicyLoss, GradientsAreThoseOfTheLoss) {
  Random random(5);
  const int batch = 6, actions = 2;
  const auto numbers = [&](size_t n, double scale) {
    std::vector<float> all(n);
    for (float& x : all) x = float(scale * random.Normal());
    return all;
  };
  std::vector<float> mean = numbers(12, 1), log_std = numbers(2, 0.3), value = numbers(6, 1);
  const std::vector<float> drawn = numbers(12, 1), old_value = numbers(6, 1),
                           advantage = numbers(6, 1), target = numbers(6, 1);
  std::vector<float> old_log_prob(6, -2.8f), mean_gradient(12), log_std_gradient(2),
      value_gradient(6);
  const auto loss = [&] {
    return ClippedPolicyLossAndGradients({.batch = batch,
                                          .action_size = actions,
                                          .mean = mean,
                                          .log_std = log_std,
                                          .value = value,
                                          .drawn_action = drawn,
                                          .old_log_prob = old_log_prob,
                                          .old_value = old_value,
                                          .advantage = advantage,
                                          .target = target,
                                          .clip = 0.3,
                                          .value_clip = 0.4,
                                          .value_weight = 0.7,
                                          .entropy_weight = 0.05},
                                         {mean_gradient, log_std_gradient, value_gradient});
  };
  const ClippedPolicyLoss at = loss();
  ASSERT_GT(at.clip_fraction, 0);
  ASSERT_LT(at.clip_fraction, 1);
  const auto expect = [&](std::vector<float>* x, const std::vector<float>& gradient) {
    const std::vector<float> analytic = gradient;
    for (size_t i = 0; i < x->size(); ++i) {
      const float here = (*x)[i], step = 1e-3f;
      (*x)[i] = here + step;
      const double above = loss().total;
      (*x)[i] = here - step;
      const double below = loss().total;
      (*x)[i] = here;
      EXPECT_NEAR((above - below) / (2 * step), analytic[i], 2e-4) << i;
    }
    loss();
  };
  expect(&mean, mean_gradient);
  expect(&log_std, log_std_gradient);
  expect(&value, value_gradient);
}

TEST(GaussianSpread, IsThatOfTheDeviations) {
  const std::vector<float> log_std{0, std::log(3.f)};
  const GaussianSpread spread = SpreadOf(log_std);
  EXPECT_NEAR(spread.deviation, 2, 1e-6);
  // Two times the entropy of a standard normal, and log 3.
  EXPECT_NEAR(spread.entropy, std::log(2 * M_PI * std::exp(1.0)) + std::log(3), 1e-6);
}

}  // namespace
}  // namespace shoal::learner
