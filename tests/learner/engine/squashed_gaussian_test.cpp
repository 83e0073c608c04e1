// SPDX-License-Identifier: Apache-2.0
#include "learner/engine/squashed_gaussian.h"

#include <cmath>
#include <numbers>
#include <vector>

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

// A sample whose arrays hold no number yet.
struct Sample {
  Sample(size_t draws, size_t actions)
      : scaled_noise(draws * actions, NAN), action(scaled_noise), log_prob(draws, NAN) {}
  SquashedValues values() { return {scaled_noise, action, log_prob}; }

  std::vector<float> scaled_noise, action, log_prob;
};

class SquashedGaussianTest : public testing::Test {
 protected:
  void Squash() {
    SquashGaussian(ToFloats(mean_), ToFloats(log_std_), ToFloats(noise_), sample_.values());
  }

  Values mean_ = RandomValues(kSize, 1), log_std_ = RandomValues(kSize, 2);
  const Values noise_ = RandomValues(kSize, 3);
  Sample sample_{kDraws, kEntries};
};

TEST_F(SquashedGaussianTest, ActionAndLogProbabilityFollowTheDefinition) {
  Squash();
  double entropy = 0;
  for (int b = 0; b < kDraws; ++b) {
    EXPECT_NEAR(sample_.log_prob[size_t(b)], LogProb(mean_, log_std_, noise_, b), 1e-5);
    entropy -= LogProb(mean_, log_std_, noise_, b) / kDraws;
  }
  for (size_t i = 0; i < kSize; ++i) {
    EXPECT_NEAR(sample_.action[i], Action(mean_, log_std_, noise_, i), 1e-6);
  }
  EXPECT_NEAR(SquashedEntropy(sample_.log_prob), entropy, 1e-5);
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
  Squash();
  std::vector<float> dmean(kSize, NAN), dlog_std(kSize, NAN);
  SquashedGaussianBackward(sample_.values(), ToFloats(action_weight), float(log_prob_weight), dmean,
                           dlog_std);
  for (size_t i = 0; i < kSize; ++i) {
    EXPECT_NEAR(dmean[i], CentralDifference(&mean_[i], loss), 1e-5);
    EXPECT_NEAR(dlog_std[i], CentralDifference(&log_std_[i], loss), 1e-5);
  }
}

// ln(1 - tanh(u)^2) = 2 (ln 2 - u) + O(e^-2u): far out the naive form is ln 0.
TEST(SquashGaussian, LogProbabilityStaysExactWhereTheActionRoundsToOne) {
  Sample sample(2, 1);
  const std::vector<float> mean{50.f, -50.f}, log_std{0.f, 0.f}, noise{0.f, 0.f};
  SquashGaussian(mean, log_std, noise, sample.values());
  EXPECT_EQ(sample.action[0], 1.f);
  EXPECT_EQ(sample.action[1], -1.f);
  const double expected = -0.5 * std::log(2 * std::numbers::pi) - 2 * (std::numbers::ln2 - 50);
  EXPECT_NEAR(sample.log_prob[0], expected, 1e-4);
  EXPECT_NEAR(sample.log_prob[1], expected, 1e-4);
}

}  // namespace
}  // namespace shoal::learner
