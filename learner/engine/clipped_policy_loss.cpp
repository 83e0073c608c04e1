// SPDX-License-Identifier: Apache-2.0
#include "learner/engine/clipped_policy_loss.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/check.h"

namespace shoal::learner {
namespace {

constexpr double kHalfLogTwoPi = 0.91893853320467274;
constexpr double kEpsilon = 1e-8;

// Advantages of the minibatch, normalised by their sample deviation if configured.
std::vector<double> AdvantagesOf(const ClippedPolicyInputs& in) {
  std::vector<double> advantages(in.advantage.begin(), in.advantage.end());
  if (!in.normalise_advantages || in.batch < 2) return advantages;
  double mean = 0, squares = 0;
  for (const double a : advantages) mean += a / in.batch;
  for (const double a : advantages) squares += (a - mean) * (a - mean);
  const double deviation = std::sqrt(squares / (in.batch - 1));
  for (double& a : advantages) a = (a - mean) / (deviation + kEpsilon);
  return advantages;
}

double LogProb(const ClippedPolicyInputs& in, size_t b) {
  double sum = 0;
  for (size_t j = 0; j < size_t(in.action_size); ++j) {
    const size_t at = b * size_t(in.action_size) + j;
    const double log_std = in.log_std[j];
    const double z = (double{in.drawn_action[at]} - double{in.mean[at]}) * std::exp(-log_std);
    sum -= z * z / 2 + log_std + kHalfLogTwoPi;
  }
  return sum;
}

// Adds the gradients that follow from dL/dlog pi of one element. With z = (u - mean) / sigma,
//   dlog pi/dmean = z / sigma,   dlog pi/dlog sigma = z^2 - 1
void AddLogProbGradient(const ClippedPolicyInputs& in, size_t b, double gradient,
                        const ClippedPolicyGradients& out, std::vector<double>* log_std) {
  for (size_t j = 0; j < size_t(in.action_size); ++j) {
    const size_t at = b * size_t(in.action_size) + j;
    const double inverse = std::exp(-double{in.log_std[j]});
    const double z = (double{in.drawn_action[at]} - double{in.mean[at]}) * inverse;
    out.mean[at] = float(gradient * z * inverse);
    (*log_std)[j] += gradient * (z * z - 1);
  }
}

// Returns the squared error of one value and writes its gradient.
double ValueError(const ClippedPolicyInputs& in, size_t b, float* gradient) {
  const double old = in.old_value[b], moved = double{in.value[b]} - old;
  const bool clipped = in.value_clip > 0 && std::abs(moved) > in.value_clip;
  const double value =
      clipped ? old + std::clamp(moved, -in.value_clip, in.value_clip) : double{in.value[b]};
  const double error = double{in.target[b]} - value;
  *gradient = clipped ? 0.f : float(-2 * in.value_weight * error / in.batch);
  return error * error;
}

}  // namespace

ClippedPolicyLoss ClippedPolicyLossAndGradients(const ClippedPolicyInputs& in,
                                                const ClippedPolicyGradients& out) {
  CHECK(in.value.size() == size_t(in.batch) && in.log_std.size() == size_t(in.action_size));
  const std::vector<double> advantages = AdvantagesOf(in);
  std::vector<double> log_std_gradient(in.log_std.size(), -in.entropy_weight);
  ClippedPolicyLoss loss;
  for (size_t b = 0; b < size_t(in.batch); ++b) {
    const double log_ratio = LogProb(in, b) - double{in.old_log_prob[b]};
    const double ratio = std::exp(log_ratio), advantage = advantages[b];
    const double plain = ratio * advantage;
    const double cut = std::clamp(ratio, 1 - in.clip, 1 + in.clip) * advantage;
    loss.policy -= std::min(plain, cut) / in.batch;
    loss.approx_kl += (ratio - 1 - log_ratio) / in.batch;
    loss.clip_fraction += (std::abs(ratio - 1) > in.clip ? 1.0 : 0.0) / in.batch;
    // If the clipped term is smaller, the ratio is beyond its clip and the gradient is 0.
    AddLogProbGradient(in, b, plain <= cut ? -plain / in.batch : 0, out, &log_std_gradient);
    loss.value += ValueError(in, b, &out.value[b]) / in.batch;
  }
  for (const float log_std : in.log_std) loss.entropy += double{log_std} + 0.5 + kHalfLogTwoPi;
  std::ranges::transform(log_std_gradient, out.log_std.begin(), [](double g) { return float(g); });
  loss.total = loss.policy + in.value_weight * loss.value - in.entropy_weight * loss.entropy;
  return loss;
}

GaussianSpread SpreadOf(std::span<const float> log_std) {
  GaussianSpread spread;
  for (const float value : log_std) {
    spread.deviation += std::exp(double{value}) / double(log_std.size());
    spread.entropy += double{value} + 1.4189385332046727;  // log(2 pi e) / 2
  }
  return spread;
}

}  // namespace shoal::learner
