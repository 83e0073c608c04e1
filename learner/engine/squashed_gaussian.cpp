// SPDX-License-Identifier: Apache-2.0
#include "learner/engine/squashed_gaussian.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace shoal::learner {
namespace {

double Softplus(double x) { return std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x))); }

// ln(1 - tanh(u)^2)
double LogTanhSlope(double u) { return 2 * (std::numbers::ln2 - u - Softplus(-2 * u)); }

}  // namespace

void SquashGaussian(std::span<const float> mean, std::span<const float> log_std,
                    std::span<const float> noise, const SquashedValues& sample) {
  const double half_log_two_pi = 0.5 * std::log(2 * std::numbers::pi);
  const size_t actions = mean.size() / sample.log_prob.size();
  for (size_t b = 0; b < sample.log_prob.size(); ++b) {
    double log_prob = 0;
    for (size_t at = b * actions; at < (b + 1) * actions; ++at) {
      const double eps = noise[at];
      const double scaled = std::exp(double(log_std[at])) * eps;
      const double u = mean[at] + scaled;
      log_prob += -0.5 * eps * eps - log_std[at] - half_log_two_pi - LogTanhSlope(u);
      sample.scaled_noise[at] = float(scaled);
      sample.action[at] = float(std::tanh(u));
    }
    sample.log_prob[b] = float(log_prob);
  }
}

void SquashedGaussianBackward(const SquashedValues& sample, std::span<const float> action_gradient,
                              float log_prob_gradient, std::span<float> mean_gradient,
                              std::span<float> log_std_gradient) {
  for (size_t i = 0; i < sample.action.size(); ++i) {
    const float a = sample.action[i];
    const float du = action_gradient[i] * (1 - a * a) + log_prob_gradient * 2 * a;
    mean_gradient[i] = du;
    log_std_gradient[i] = du * sample.scaled_noise[i] - log_prob_gradient;
  }
}

float SquashedEntropy(std::span<const float> log_prob) {
  double sum = 0;
  for (const float value : log_prob) sum -= value;
  return float(sum / int(log_prob.size()));
}

}  // namespace shoal::learner
