// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/sac/quantile_values.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>

#include "tests/common/nn/gradient_check.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

using nn::CentralDifference;
using nn::RandomValues;
using nn::ToFloats;
using nn::reference::Values;
using testing::ElementsAre;
using testing::FloatNear;

// Two critics of three quantiles each and two rows.
constexpr std::array<float, 6> kFirst{5, -1, 2, 0, 0, 0}, kSecond{3, 9, -4, 1, 2, 3};
constexpr std::array<std::span<const float>, 2> kNext{kFirst, kSecond};
constexpr std::array<float, 2> kBase{10, 20}, kBootstrap{1, 0.5f};

TEST(QuantileTargets, AreTheSmallestOfTheQuantilesOfAllCritics) {
  std::array<float, 8> y{};
  std::array<float, 2> means{};
  QuantileTargets({kNext, kBase, kBootstrap}, /*discount=*/0.5f, /*bounds=*/{}, y, means);
  const std::span<float> all(y);
  EXPECT_THAT(all.first(4), testing::UnorderedElementsAre(8, 9.5f, 11, 11.5f));
  EXPECT_THAT(all.last(4), testing::UnorderedElementsAre(20, 20, 20, 20.25f));
  EXPECT_THAT(means, ElementsAre(10, 20.0625f));
}

TEST(QuantileTargets, BoundTheQuantilesAndNotTheRest) {
  std::array<float, 12> y{};
  std::array<float, 2> means{};
  QuantileTargets({kNext, kBase, kBootstrap}, 1, {.low = -2, .high = 2.5f}, y, means);
  EXPECT_THAT(std::span<float>(y).first(6),
              testing::UnorderedElementsAre(8, 9, 12, 12.5f, 12.5f, 12.5f));
}

// Also if the quantile is among those that are left out.
TEST(QuantileTargets, AreNotANumberIfAQuantileIsNone) {
  for (size_t at = 0; at < 3; ++at) {
    std::array<float, 6> faulty = kFirst;
    faulty[at] = std::numeric_limits<float>::quiet_NaN();
    const std::array<std::span<const float>, 2> next{faulty, kSecond};
    std::array<float, 8> y{};
    std::array<float, 2> means{};
    QuantileTargets({next, kBase, kBootstrap}, 1, {}, y, means);
    EXPECT_TRUE(std::isnan(means[0])) << at;
    EXPECT_THAT(std::span<float>(y).last(4), testing::UnorderedElementsAre(20, 20, 20, 20.5f));
  }
}

constexpr size_t kLossRows = 3, kQuantiles = 5, kTargets = 4;

// The loss, written as in the paper.
double ReferenceLoss(const Values& q, const Values& y) {
  double sum = 0;
  for (size_t b = 0; b < kLossRows; ++b) {
    for (size_t m = 0; m < kQuantiles; ++m) {
      const double tau = (2.0 * double(m) + 1) / (2.0 * kQuantiles);
      for (size_t j = 0; j < kTargets; ++j) {
        const double u = y[b * kTargets + j] - q[b * kQuantiles + m];
        const double huber = std::abs(u) <= 1 ? u * u / 2 : std::abs(u) - 0.5;
        sum += std::abs(tau - (u < 0 ? 1 : 0)) * huber;
      }
    }
  }
  return sum / (kLossRows * kQuantiles * kTargets);
}

TEST(QuantileLoss, IsTheReferenceWithItsCentralDifferencesAsGradient) {
  Values q = RandomValues(kLossRows * kQuantiles, 1);
  for (double& value : q) value *= 3;  // differences on both sides of 1
  const Values y = RandomValues(kLossRows * kTargets, 2);
  std::array<float, kLossRows> losses{1, 2, 3};  // of the critics before
  std::array<float, kLossRows * kQuantiles> gradient{};
  QuantileLoss(ToFloats(q), ToFloats(y), losses, gradient);
  const auto loss = [&] { return ReferenceLoss(q, y); };
  EXPECT_NEAR((losses[0] + losses[1] + losses[2] - 6) / kLossRows, loss(), 1e-6);
  for (size_t i = 0; i < q.size(); ++i) {
    EXPECT_NEAR(gradient[i], CentralDifference(&q[i], loss), 1e-6) << i;
  }
}

// Half of the targets lie below the middle quantile, a tenth below the first one, and so on.
TEST(QuantileLoss, IsLeastForTheQuantilesOfTheTargets) {
  std::array<float, 100> y{};
  for (size_t j = 0; j < y.size(); ++j) y[j] = float(j) * 10 + 5;  // far apart: Huber's linear part
  std::array<float, kQuantiles> q{}, gradient{};
  for (int step = 0; step < 20'000; ++step) {
    std::array<float, 1> loss{};
    QuantileLoss(q, y, loss, gradient);
    for (size_t m = 0; m < q.size(); ++m) q[m] -= 20 * gradient[m];
  }
  EXPECT_THAT(q, ElementsAre(FloatNear(100, 6), FloatNear(300, 6), FloatNear(500, 6),
                             FloatNear(700, 6), FloatNear(900, 6)));
}

TEST(QuantileLoss, IsNotFiniteIfATargetOrAQuantileIsNot) {
  const Values q = RandomValues(kLossRows * kQuantiles, 1),
               y = RandomValues(kLossRows * kTargets, 2);
  for (const float fault :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    std::vector<float> faulty_q = ToFloats(q), faulty_y = ToFloats(y);
    faulty_q[7] = fault;
    faulty_y[5] = fault;
    std::array<float, kLossRows> losses{}, of_targets{};
    std::array<float, kLossRows * kQuantiles> gradient{};
    QuantileLoss(faulty_q, ToFloats(y), losses, gradient);
    EXPECT_FALSE(std::isfinite(losses[1])) << fault;
    QuantileLoss(ToFloats(q), faulty_y, of_targets, gradient);
    EXPECT_FALSE(std::isfinite(of_targets[1])) << fault;
    EXPECT_TRUE(std::isfinite(losses[0]) && std::isfinite(of_targets[0]));
  }
}

Config QuantileConfig(const std::string& actor_value) {
  Config config;
  config.sac.quantiles = 10;
  config.sac.actor_value = actor_value;
  return config;
}

TEST(QuantileAgent, LearnsABandit) {
  for (const char* actor_value : {"min", "mean"}) {
    EXPECT_LT(BanditError(QuantileConfig(actor_value), MakeAgent), 0.08) << actor_value;
  }
}

}  // namespace
}  // namespace shoal::learner
