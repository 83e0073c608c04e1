// SPDX-License-Identifier: Apache-2.0
// Compares the kernels of policies with the operations of the CPU.
#include "learner/device/kernels/gaussian.h"

#include <algorithm>

#include "learner/device/kernels/policy_heads.h"
#include "learner/engine/losses.h"
#include "learner/engine/squashed_gaussian.h"
#include "tests/learner/device/kernels/kernel_fixture.h"

namespace shoal::learner::kernels {
namespace {

class GaussianKernels : public KernelTest {
 protected:
  void CompareSample(int rows, int actions) {
    const auto n = size_t(rows) * size_t(actions);
    const std::vector<float> mean = Random(n, -3, 3), log_std = Random(n, -5, 2);
    const std::vector<float> noise = Random(n, -3, 3), gradient = Random(n);
    std::vector<float> scaled(n), action(n), log_prob(n / size_t(actions));
    SquashGaussian(mean, log_std, noise, {scaled, action, log_prob});
    SampleSquashedGaussian sample{.rows = rows,
                                  .actions = actions,
                                  .mean = In(mean),
                                  .log_std = In(log_std),
                                  .noise = In(noise),
                                  .scaled_noise = Out(n),
                                  .action = Out(n),
                                  .log_prob = Out(size_t(rows))};
    Run(sample);
    ExpectClose(sample.scaled_noise, scaled, 1e-6);
    ExpectClose(sample.action, action, 1e-6);
    ExpectClose(sample.log_prob, log_prob, 1e-6);

    std::vector<float> mean_gradient(n), log_std_gradient(n);
    learner::SquashedGaussianBackward({scaled, action, log_prob}, gradient, 0.7f / float(rows),
                                      mean_gradient, log_std_gradient);
    SquashedGaussianBackward backward{.rows = rows,
                                      .actions = actions,
                                      .scaled_noise = In(scaled),
                                      .action = In(action),
                                      .action_gradient = In(gradient),
                                      .temperature = In(std::vector<double>{0.7f}),
                                      .mean_gradient = Out(n),
                                      .log_std_gradient = Out(n)};
    Run(backward);
    ExpectClose(backward.mean_gradient, mean_gradient, 1e-6);
    ExpectClose(backward.log_std_gradient, log_std_gradient, 1e-6);

    SquashedGaussianFigures figures{.rows = rows,
                                    .actions = actions,
                                    .log_prob = In(log_prob),
                                    .action = In(action),
                                    .entropy = Out<double>(1),
                                    .saturation = Out<double>(1)};
    Run(figures);
    const float entropy = SquashedEntropy(log_prob);
    EXPECT_NEAR(*figures.entropy, entropy, 1e-6 * std::abs(entropy));
    EXPECT_EQ(*figures.saturation, float(SaturatedShare(action)));
    if (n > 100) {
      EXPECT_GT(*figures.saturation, 0);
    }
  }

  // Compares with the formulas of common/nn/actor_head.h.
  void CompareHead(bool clamped) {
    constexpr int kRows = 71, kActions = 3;
    constexpr size_t kNumbers = size_t(kRows) * kActions;
    const std::vector<float> output = Random(2 * kNumbers, -25, 5);
    GaussianHead head{.rows = kRows,
                      .actions = kActions,
                      .clamped = clamped,
                      .output = In(output),
                      .mean = Out(kNumbers),
                      .log_std = Out(kNumbers)};
    Run(head);
    const std::vector<float> to_mean = Random(kNumbers), to_log_std = Random(kNumbers);
    float* gradient = Out(2 * kNumbers);
    Run(GaussianHeadBackward{.rows = kRows,
                             .actions = kActions,
                             .clamped = clamped,
                             .output = head.output,
                             .log_std = head.log_std,
                             .mean_gradient = In(to_mean),
                             .log_std_gradient = In(to_log_std),
                             .output_gradient = {gradient, nullptr}});
    for (size_t at = 0; at < kNumbers; ++at) {
      const size_t column = at / kActions * 2 * kActions + at % kActions;
      const double raw = output[column + kActions], t = std::tanh(raw);
      const double slope = clamped ? (raw >= -20 && raw <= 2 ? 1 : 0) : 3.5 * (1 - t * t);
      EXPECT_EQ(head.mean[at], output[column]);
      EXPECT_NEAR(head.log_std[at], clamped ? std::clamp(raw, -20.0, 2.0) : -5 + 3.5 * (t + 1),
                  1e-5);
      EXPECT_EQ(gradient[column], to_mean[at]);
      EXPECT_NEAR(gradient[column + kActions], slope * to_log_std[at], 1e-5);
    }
  }
};

TEST_F(GaussianKernels, SquashedSamplesAndTheirGradients) {
  CompareSample(128, 4);
  CompareSample(37, 3);
  CompareSample(5, 1);
  CompareSample(3, 300);  // a row takes several rounds
}

TEST_F(GaussianKernels, HeadsAreSplit) {
  CompareHead(/*clamped=*/false);
  CompareHead(/*clamped=*/true);
}

TEST_F(GaussianKernels, DeterministicHeads) {
  constexpr size_t kNumbers = 77;
  const std::vector<float> mean = Random(kNumbers, -2, 2), gradient = Random(kNumbers);
  float *action = Out(kNumbers), *to_mean = Out(kNumbers);
  const float* of_mean = In(mean);
  Run(TanhHead{.n = kNumbers, .mean = of_mean, .action = action});
  Run(TanhHeadBackward{.n = kNumbers,
                       .penalty_slope = 0.25f,
                       .mean = of_mean,
                       .action = action,
                       .action_gradient = In(gradient),
                       .mean_gradient = {to_mean, nullptr}});
  for (size_t i = 0; i < kNumbers; ++i) {
    const double t = std::tanh(double(mean[i]));
    EXPECT_NEAR(action[i], t, 1e-6);
    EXPECT_NEAR(to_mean[i], gradient[i] * (1 - t * t) + 0.25 * mean[i], 1e-5);
  }
}

TEST_F(GaussianKernels, NoiseIsClippedTwice) {
  constexpr size_t kNumbers = 1100;
  const std::vector<float> action = Random(kNumbers), draws = Random(kNumbers, -3, 3);
  const std::vector<double> noise(draws.begin(), draws.end());
  float* noisy = Out(kNumbers);
  Run(AddClippedNoise{.n = kNumbers,
                      .sigma = In(std::vector<double>{0.4}),
                      .limit = 0.5,
                      .action = In(action),
                      .noise = In(noise),
                      .noisy = noisy});
  for (size_t i = 0; i < kNumbers; ++i) {
    EXPECT_EQ(noisy[i],
              float(std::clamp(action[i] + std::clamp(0.4 * noise[i], -0.5, 0.5), -1.0, 1.0)));
  }
}

TEST_F(GaussianKernels, DeviationAndEntropyOfAGaussian) {
  for (const size_t actions : {1u, 5u, 70u}) {
    const std::vector<float> log_std = Random(actions, -3, 2);
    const GaussianFigures figures{.actions = int(actions),
                                  .log_std = In(log_std),
                                  .deviation = Out<double>(1),
                                  .entropy = Out<double>(1)};
    Run(figures);
    double deviation = 0, entropy = 0;
    for (const float s : log_std) {
      deviation += std::exp(double(s)) / double(actions);
      entropy += s + std::log(2 * M_PI * M_E) / 2;
    }
    EXPECT_NEAR(*figures.deviation, deviation, 1e-12 * deviation);
    EXPECT_NEAR(*figures.entropy, entropy, 1e-12 * (1 + std::abs(entropy)));
  }
}

}  // namespace
}  // namespace shoal::learner::kernels
