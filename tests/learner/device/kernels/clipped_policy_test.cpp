// SPDX-License-Identifier: Apache-2.0
// Compares the kernels of the clipped loss with formulas in double.
#include "learner/device/kernels/clipped_policy.h"

#include <algorithm>
#include <numeric>

#include "tests/learner/device/kernels/kernel_fixture.h"

namespace shoal::learner::kernels {
namespace {

struct ClippedCase {
  int rows = 0, actions = 0;
  bool normalise = true;
  double value_clip = 0;
};

class ClippedPolicyKernels : public KernelTest {
 protected:
  static constexpr double kBound = 0.25, kValueWeight = 0.7, kEntropyWeight = 0.3;

  // Inputs whose ratios are on both sides of both bounds.
  struct Inputs {
    std::vector<float> mean, u, log_std, old_log_prob, advantage, value, old_value, target;
  };
  Inputs Draw(const ClippedCase& of) {
    const auto rows = size_t(of.rows), actions = size_t(of.actions);
    Inputs in{.mean = Random(rows * actions, -2, 2),
              .u = Random(rows * actions, -2, 2),
              .log_std = Random(actions, -1, 1),
              .old_log_prob = Random(rows, -0.8, 0.8),
              .advantage = Random(rows, -1, 3),
              .value = Random(rows),
              .old_value = Random(rows),
              .target = Random(rows, -2, 2)};
    for (size_t b = 0; b < rows; ++b) in.old_log_prob[b] += float(LogProb(in, b));
    return in;
  }

  static double Z(const Inputs& in, size_t b, size_t j) {
    const size_t at = b * in.log_std.size() + j;
    return (double(in.u[at]) - in.mean[at]) / std::exp(double(in.log_std[j]));
  }
  static double LogProb(const Inputs& in, size_t b) {
    double sum = 0;
    for (size_t j = 0; j < in.log_std.size(); ++j) {
      sum += -Z(in, b, j) * Z(in, b, j) / 2 - in.log_std[j] - std::log(2 * M_PI) / 2;
    }
    return sum;
  }

  // The advantages with which the loss computes.
  static std::vector<double> UsedAdvantages(const Inputs& in, bool normalise) {
    std::vector<double> a(in.advantage.begin(), in.advantage.end());
    if (!normalise || a.size() == 1) return a;
    const double n = double(a.size()), mean = std::accumulate(a.begin(), a.end(), 0.0) / n;
    double squares = 0;
    for (double& each : a) each -= mean;
    for (const double each : a) squares += each * each;
    for (double& each : a) each /= std::sqrt(squares / (n - 1)) + 1e-8;
    return a;
  }

  struct Expected {
    std::vector<float> mean, value, log_std;
    double policy = 0, squares = 0, entropy = 0, kl = 0, clipped = 0;
  };
  static Expected ExpectedOf(const Inputs& in, const ClippedCase& of) {
    const size_t actions = in.log_std.size();
    const double n = of.rows;
    const std::vector<double> advantage = UsedAdvantages(in, of.normalise);
    std::vector<double> log_std(actions, -kEntropyWeight);
    Expected to;
    for (size_t b = 0; b < in.value.size(); ++b) {
      const double log_ratio = LogProb(in, b) - in.old_log_prob[b], ratio = std::exp(log_ratio);
      const bool outside = advantage[b] > 0 ? ratio > 1 + kBound : ratio < 1 - kBound;
      const double used = outside ? (ratio > 1 ? 1 + kBound : 1 - kBound) : ratio;
      to.policy -= used * advantage[b] / n;
      to.kl += (ratio - 1 - log_ratio) / n;
      to.clipped += ratio > 1 + kBound || ratio < 1 - kBound ? 1 / n : 0;
      const double to_log_prob = outside ? 0 : -ratio * advantage[b] / n;
      for (size_t j = 0; j < actions; ++j) {
        const double z = Z(in, b, j);
        to.mean.push_back(float(to_log_prob * z / std::exp(double(in.log_std[j]))));
        log_std[j] += to_log_prob * (z * z - 1);
      }
      const double moved = double(in.value[b]) - in.old_value[b];
      const bool fixed = of.value_clip > 0 && std::abs(moved) > of.value_clip;
      const double value =
          fixed ? in.old_value[b] + std::copysign(of.value_clip, moved) : in.value[b];
      to.squares += (value - in.target[b]) * (value - in.target[b]) / n;
      to.value.push_back(fixed ? 0 : float(2 * kValueWeight * (value - in.target[b]) / n));
    }
    for (const float s : in.log_std) to.entropy += s + std::log(2 * M_PI * M_E) / 2;
    to.log_std.assign(log_std.begin(), log_std.end());
    return to;
  }

  static void ExpectNumber(const double* number, double expected) {
    EXPECT_NEAR(*number, expected, 1e-12 * (1 + std::abs(expected)));
  }

  void Compare(const ClippedCase& of) {
    const Inputs in = Draw(of);
    const auto rows = size_t(of.rows), actions = size_t(of.actions);
    const PrepareClippedPolicy prepare{.rows = of.rows,
                                       .actions = of.actions,
                                       .normalise = of.normalise,
                                       .advantage = In(in.advantage),
                                       .log_std = In(in.log_std),
                                       .inverse_sigma = Out<double>(actions),
                                       .constants = Out<ClippedPolicyConstants>(1)};
    Run(prepare);
    const auto blocks = size_t(ClippedPolicyRows::BlocksFor(of.rows));
    const auto number = [this] { return Out<double>(1); };
    const ClippedPolicyRows loss{
        .rows = of.rows,
        .actions = of.actions,
        .mean = In(in.mean),
        .drawn_action = In(in.u),
        .inverse_sigma = prepare.inverse_sigma,
        .old_log_prob = In(in.old_log_prob),
        .advantage = prepare.advantage,
        .value = In(in.value),
        .old_value = In(in.old_value),
        .target = In(in.target),
        .constants = prepare.constants,
        .clip = In(std::vector<double>{kBound}),
        .value_clip = of.value_clip,
        .value_weight = kValueWeight,
        .entropy_weight = kEntropyWeight,
        .mean_gradient = Out(rows * actions),
        .value_gradient = Out(rows),
        .log_prob_gradient = Out<double>(rows),
        .partials = Out<ClippedPolicyRows::Terms>(blocks),
        .finished = Counters(1),
        .figures = {number(), number(), number(), number(), number(), number()}};
    Run(loss);
    EXPECT_EQ(*loss.finished, 0);
    const LogStdGradient deviations{.rows = of.rows,
                                    .actions = of.actions,
                                    .mean = loss.mean,
                                    .drawn_action = loss.drawn_action,
                                    .inverse_sigma = prepare.inverse_sigma,
                                    .log_prob_gradient = loss.log_prob_gradient,
                                    .entropy_weight = kEntropyWeight,
                                    .gradient = Out(actions)};
    Run(deviations);

    const Expected expected = ExpectedOf(in, of);
    ExpectClose(loss.mean_gradient, expected.mean, 1e-6);
    ExpectClose(loss.value_gradient, expected.value, 1e-6);
    ExpectClose(deviations.gradient, expected.log_std, 1e-6);
    const double total =
        expected.policy + kValueWeight * expected.squares - kEntropyWeight * expected.entropy;
    ExpectNumber(loss.figures.policy, expected.policy);
    ExpectNumber(loss.figures.value, expected.squares);
    ExpectNumber(loss.figures.total, total);
    EXPECT_EQ(*loss.figures.rounded_total, float(*loss.figures.total));
    ExpectNumber(loss.figures.approx_kl, expected.kl);
    ExpectNumber(loss.figures.clip_fraction, expected.clipped);
  }
};

TEST_F(ClippedPolicyKernels, LossesFiguresAndGradients) {
  Compare({.rows = 64, .actions = 4});
  Compare({.rows = 300, .actions = 3, .normalise = false, .value_clip = 0.4});
  Compare({.rows = 128, .actions = 1, .value_clip = 0.4});
  Compare({.rows = 7, .actions = 21});
  // More blocks than a block has threads, and more actions than a warp.
  Compare({.rows = 129 * ClippedPolicyRows::kThreads + 1, .actions = 2});
  Compare({.rows = 5, .actions = 300, .normalise = false});
}

TEST_F(ClippedPolicyKernels, OneRowIsNotNormalised) { Compare({.rows = 1, .actions = 2}); }

// Normalised advantages of equal rows are 0, not NaN.
TEST_F(ClippedPolicyKernels, EqualAdvantagesAreFinite) {
  const PrepareClippedPolicy prepare{.rows = 4,
                                     .actions = 1,
                                     .advantage = In(std::vector<float>(4, 0.5f)),
                                     .log_std = In(std::vector<float>{0}),
                                     .inverse_sigma = Out<double>(1),
                                     .constants = Out<ClippedPolicyConstants>(1)};
  Run(prepare);
  EXPECT_EQ(prepare.constants->advantage_mean, 0.5);
  EXPECT_NEAR(prepare.constants->advantage_factor, 1e8, 1);
}

// A loss that is not finite must be visible in the total, which the flag depends on.
TEST_F(ClippedPolicyKernels, ARatioThatOverflowsIsNotFinite) {
  double* total = Out<double>(1);
  const auto number = [this] { return Out<double>(1); };
  const ClippedPolicyConstants as_it_is{0, 1, 0};
  Run(ClippedPolicyRows{.rows = 1,
                        .actions = 1,
                        .mean = In(std::vector<float>{0}),
                        .drawn_action = In(std::vector<float>{0}),
                        .inverse_sigma = In(std::vector<double>{1}),
                        .old_log_prob = In(std::vector<float>{-3e38f}),
                        .advantage = In(std::vector<float>{-1}),
                        .value = In(std::vector<float>{0}),
                        .old_value = In(std::vector<float>{0}),
                        .target = In(std::vector<float>{0}),
                        .constants = In(std::vector<ClippedPolicyConstants>{as_it_is}),
                        .clip = In(std::vector<double>{kBound}),
                        .mean_gradient = Out(1),
                        .value_gradient = Out(1),
                        .log_prob_gradient = Out<double>(1),
                        .partials = Out<ClippedPolicyRows::Terms>(1),
                        .finished = Counters(1),
                        .figures = {number(), number(), total, number(), number(), number()}});
  EXPECT_FALSE(std::isfinite(*total)) << *total;
}

}  // namespace
}  // namespace shoal::learner::kernels
