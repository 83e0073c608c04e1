// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/squashed_gaussian.h"

#include <cmath>
#include <numbers>

namespace shoal::learner {
namespace {

double Softplus(double x) { return std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x))); }

// ln(1 - tanh(u)^2)
double LogTanhSlope(double u) { return 2 * (std::numbers::ln2 - u - Softplus(-2 * u)); }

}  // namespace

SquashedGaussian::SquashedGaussian(int batch, int action_size)
    : batch_(batch),
      action_size_(action_size),
      noise_(size_t(batch) * size_t(action_size)),
      scaled_noise_(noise_.size()),
      action_(noise_.size()),
      log_prob_(size_t(batch)) {}

void SquashedGaussian::Sample(const float* mean, const float* log_std, Random* random) {
  for (float& eps : noise_) eps = float(random->Normal());
  Transform(mean, log_std, noise_.data());
}

void SquashedGaussian::Transform(const float* mean, const float* log_std, const float* noise) {
  const double half_log_two_pi = 0.5 * std::log(2 * std::numbers::pi);
  for (int b = 0; b < batch_; ++b) {
    double log_prob = 0;
    for (int j = 0; j < action_size_; ++j) {
      const size_t at = size_t(b) * size_t(action_size_) + size_t(j);
      const double eps = noise[at];
      const double scaled = std::exp(double(log_std[at])) * eps;
      const double u = mean[at] + scaled;
      log_prob += -0.5 * eps * eps - log_std[at] - half_log_two_pi - LogTanhSlope(u);
      noise_[at] = noise[at];
      scaled_noise_[at] = float(scaled);
      action_[at] = float(std::tanh(u));
    }
    log_prob_[size_t(b)] = float(log_prob);
  }
}

void SquashedGaussian::Backward(const float* action_gradient, float log_prob_gradient,
                                float* mean_gradient, float* log_std_gradient) const {
  for (size_t i = 0; i < action_.size(); ++i) {
    const float a = action_[i];
    const float du = action_gradient[i] * (1 - a * a) + log_prob_gradient * 2 * a;
    mean_gradient[i] = du;
    log_std_gradient[i] = du * scaled_noise_[i] - log_prob_gradient;
  }
}

float SquashedGaussian::Entropy() const {
  double sum = 0;
  for (const float log_prob : log_prob_) sum -= log_prob;
  return float(sum / batch_);
}

float SquashedGaussian::Saturation() const {
  int64_t saturated = 0;
  for (const float a : action_) saturated += std::abs(a) > 0.99f;
  return float(double(saturated) / double(action_.size()));
}

}  // namespace shoal::learner
