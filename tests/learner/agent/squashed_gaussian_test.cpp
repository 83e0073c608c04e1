// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/squashed_gaussian.h"

#include <cmath>
#include <numbers>

#include "tests/common/nn/gradient_check.h"

namespace shoal::learner {
namespace {

using nn::CentralDifference;
using nn::RandomValues;
using nn::ToFloats;
using nn::reference::Values;

constexpr int kDraws = 3, kEntries = 2;
constexpr size_t kSize = kDraws * kEntries;

// Straight from the definition: Gaussian density divided by the slope of tanh.
double LogProb(const Values& mean, const Values& log_std, const Values& noise, int b) {
  double sum = 0;
  for (int j = 0; j < kEntries; ++j) {
    const size_t i = size_t(b) * kEntries + j;
    const double sigma = std::exp(log_std[i]), u = mean[i] + sigma * noise[i];
    const double z = (u - mean[i]) / sigma;
    sum += -0.5 * z * z - std::log(sigma * std::sqrt(2 * std::numbers::pi));
    sum -= std::log(1 - std::tanh(u) * std::tanh(u));
  }
  return sum;
}

double Action(const Values& mean, const Values& log_std, const Values& noise, size_t i) {
  return std::tanh(mean[i] + std::exp(log_std[i]) * noise[i]);
}

class SquashedGaussianTest : public testing::Test {
 protected:
  Values mean_ = RandomValues(kSize, 1), log_std_ = RandomValues(kSize, 2);
  const Values noise_ = RandomValues(kSize, 3);
  SquashedGaussian gaussian_{kDraws, kEntries};
};

TEST_F(SquashedGaussianTest, ActionAndLogProbabilityFollowTheDefinition) {
  gaussian_.Transform(ToFloats(mean_).data(), ToFloats(log_std_).data(), ToFloats(noise_).data());
  double entropy = 0;
  for (int b = 0; b < kDraws; ++b) {
    EXPECT_NEAR(gaussian_.log_prob()[b], LogProb(mean_, log_std_, noise_, b), 1e-5);
    entropy -= LogProb(mean_, log_std_, noise_, b) / kDraws;
  }
  for (size_t i = 0; i < kSize; ++i) {
    EXPECT_NEAR(gaussian_.action()[i], Action(mean_, log_std_, noise_, i), 1e-6);
  }
  EXPECT_NEAR(gaussian_.Entropy(), entropy, 1e-5);
}

TEST_F(SquashedGaussianTest, GradientsAreCentralDifferences) {
  const Values action_weight = RandomValues(kSize, 4);
  const double log_prob_weight = 0.7;
  const auto loss = [&] {
    double sum = 0;
    for (size_t i = 0; i < kSize; ++i) {
      sum += action_weight[i] * Action(mean_, log_std_, noise_, i);
    }
    for (int b = 0; b < kDraws; ++b) sum += log_prob_weight * LogProb(mean_, log_std_, noise_, b);
    return sum;
  };
  gaussian_.Transform(ToFloats(mean_).data(), ToFloats(log_std_).data(), ToFloats(noise_).data());
  std::vector<float> dmean(kSize), dlog_std(kSize);
  gaussian_.Backward(ToFloats(action_weight).data(), float(log_prob_weight), dmean.data(),
                     dlog_std.data());
  for (size_t i = 0; i < kSize; ++i) {
    EXPECT_NEAR(dmean[i], CentralDifference(&mean_[i], loss), 1e-5);
    EXPECT_NEAR(dlog_std[i], CentralDifference(&log_std_[i], loss), 1e-5);
  }
}

// ln(1 - tanh(u)^2) = 2 (ln 2 - u) + O(e^-2u): far out the naive form is ln 0.
TEST(SquashedGaussian, LogProbabilityStaysExactWhereTheActionRoundsToOne) {
  SquashedGaussian gaussian(2, 1);
  const std::vector<float> mean{50.f, -50.f}, log_std{0.f, 0.f}, noise{0.f, 0.f};
  gaussian.Transform(mean.data(), log_std.data(), noise.data());
  EXPECT_EQ(gaussian.action()[0], 1.f);
  EXPECT_EQ(gaussian.action()[1], -1.f);
  const double expected = -0.5 * std::log(2 * std::numbers::pi) - 2 * (std::numbers::ln2 - 50);
  EXPECT_NEAR(gaussian.log_prob()[0], expected, 1e-4);
  EXPECT_NEAR(gaussian.log_prob()[1], expected, 1e-4);
  EXPECT_EQ(gaussian.Saturation(), 1.f);
}

TEST(SquashedGaussian, SamplesHaveTheAskedMeanAndDeviationAndRepeatWithTheirStream) {
  constexpr int kSamples = 20'000;
  const std::vector<float> mean(kSamples, 0.3f), log_std(kSamples, std::log(0.2f));
  SquashedGaussian gaussian(kSamples, 1), again(kSamples, 1);
  Random random(9), same(9);
  gaussian.Sample(mean.data(), log_std.data(), &random);
  again.Sample(mean.data(), log_std.data(), &same);
  double sum = 0, squares = 0;
  for (int i = 0; i < kSamples; ++i) {
    EXPECT_EQ(gaussian.action()[i], again.action()[i]);
    const double u = std::atanh(double(gaussian.action()[i]));
    sum += u;
    squares += (u - 0.3) * (u - 0.3);
  }
  EXPECT_NEAR(sum / kSamples, 0.3, 5 * 0.2 / std::sqrt(kSamples));
  // The deviation of a sample variance of a Gaussian is variance * sqrt(2 / n).
  EXPECT_NEAR(squares / kSamples, 0.04, 5 * 0.04 * std::sqrt(2.0 / kSamples));
}

}  // namespace
}  // namespace shoal::learner
