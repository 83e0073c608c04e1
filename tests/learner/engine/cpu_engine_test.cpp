// SPDX-License-Identifier: Apache-2.0
// Compares the operations of the CPU's engine with simple references in double precision on random
// numbers; result arrays are filled with invalid values before. Compares replicas with one engine
// that has the whole batch.
#include "learner/engine/cpu_engine.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <deque>
#include <numbers>
#include <set>
#include <utility>

#include "common/nn/host_memory.h"
#include "common/nn/team.h"
#include "learner/agent/figure_sheet.h"
#include "tests/learner/engine/cpu_engine_fixture.h"

namespace shoal::learner {
namespace {

using nn::HostValues;
using nn::ParameterSet;
using nn::RelativeError;
using nn::reference::Values;
using testing::Each;
using testing::ElementsAre;

TEST_F(CpuEngineTest, TargetsAreTheRewardAndTheBoundedSmallestValueLessTheEntropyTerm) {
  const std::array q{Filled(1, 1), Filled(1, 2)};
  const Array log_prob = Filled(1, 3), y = Poisoned(1), without = Poisoned(1);
  TargetTerms terms{.reward = batch_.reward,
                    .bootstrap = batch_.bootstrap,
                    .next_q = q,
                    .next_log_prob = log_prob,
                    .temperature = Holding(0.3),
                    .reward_scale = 2,
                    .discount = 0.9f,
                    .bounds = {.low = -0.5f, .high = 0.25f}};
  engine_.Targets(terms, y);
  terms.next_log_prob = {};
  engine_.Targets(terms, without);
  Values expected, expected_without;
  for (size_t b = 0; b < kBatch; ++b) {
    const double value = std::clamp(std::min(Of(q[0])[b], Of(q[1])[b]), -0.5, 0.25);
    const double reward = 2 * Of(batch_.reward)[b], share = 0.9 * Of(batch_.bootstrap)[b];
    expected.push_back(reward + share * (value - 0.3 * Of(log_prob)[b]));
    expected_without.push_back(reward + share * value);
  }
  EXPECT_LT(RelativeError(HostValues(y), expected), kTolerance);
  EXPECT_LT(RelativeError(HostValues(without), expected_without), kTolerance);
}

// The reference tries all pairs. One pair fits the whole batch.
TEST_F(CpuEngineTest, TargetsOfDrawnCriticsAreTheSmallestValueOfTheseCritics) {
  const std::array q{Filled(1, 1), Filled(1, 2), Filled(1, 3), Filled(1, 4)};
  const Array y = Poisoned(1);
  Random random(5);
  std::set<std::pair<size_t, size_t>> drawn;
  for (int draw = 0; draw < 60; ++draw) {
    engine_.Targets({.reward = batch_.reward,
                     .bootstrap = batch_.bootstrap,
                     .next_q = q,
                     .drawn = 2,
                     .random = &random,
                     .next_log_prob = {},
                     .temperature = {},
                     .reward_scale = 1,
                     .discount = 0.9f,
                     .bounds = {}},
                    y);
    int fitting = 0;
    for (size_t i = 0; i < q.size(); ++i) {
      for (size_t j = i + 1; j < q.size(); ++j) {
        Values expected;
        for (size_t b = 0; b < kBatch; ++b) {
          const double value = std::min(Of(q[i])[b], Of(q[j])[b]);
          expected.push_back(Of(batch_.reward)[b] + 0.9 * Of(batch_.bootstrap)[b] * value);
        }
        if (RelativeError(HostValues(y), expected) > kTolerance) continue;
        drawn.insert({i, j});
        ++fitting;
      }
    }
    ASSERT_EQ(fitting, 1);
  }
  EXPECT_EQ(drawn.size(), 6u) << "pairs that were drawn";
}

TEST_F(CpuEngineTest, AnActorsLossByTheMeanOfTheCritics) {
  const std::array q{Filled(1, 1), Filled(1, 2), Filled(1, 3)};
  const std::array gradients{Poisoned(1), Poisoned(1), Poisoned(1)};
  const Array log_prob = Filled(1, 4);
  const Number loss = Holding(NAN);
  engine_.EntropyActorLoss(log_prob, q, ActorValue::kMean, Holding(0.4), gradients, loss);
  engine_.Gather(&adam_, Holding(NAN));
  double expected = 0;
  for (size_t b = 0; b < kBatch; ++b) {
    expected += 0.4 * Of(log_prob)[b] / kBatch;
    for (const Array values : q) expected -= Of(values)[b] / (3 * kBatch);
  }
  EXPECT_NEAR(engine_.Read(loss), expected, kTolerance);
  for (const Array gradient : gradients) {
    EXPECT_THAT(Of(gradient), Each(testing::DoubleNear(-1.0 / (3 * kBatch), kTolerance)));
  }
}

TEST_F(CpuEngineTest, ACriticsLossHasItsGradientsAtOnceAndItsFiguresAfterGather) {
  const std::array q{Filled(1, 1), Filled(1, 2)};
  const Array y = Filled(1, 3);
  const std::array gradients{Poisoned(1), Poisoned(1)};
  CriticNumbers to;
  for (Number* number :
       {&to.loss, &to.q_mean, &to.target_mean, &to.q1_mean, &to.q1_std, &to.q2_mean, &to.q2_std,
        &to.q_min_mean, &to.q_min_std, &to.q_min_min, &to.q_min_max}) {
    *number = Holding(NAN);
  }
  engine_.CriticLoss(q, y, /*rows=*/{}, gradients, to);
  engine_.Gather(&adam_, Holding(NAN));
  double loss = 0, target_mean = 0, mean[2] = {}, square[2] = {}, least_mean = 0, least_square = 0;
  double smallest = INFINITY, largest = -INFINITY;
  for (size_t b = 0; b < kBatch; ++b) {
    target_mean += Of(y)[b] / kBatch;
    for (size_t i = 0; i < 2; ++i) {
      const double error = Of(q[i])[b] - Of(y)[b];
      EXPECT_NEAR(HostValues(gradients[i])[b], 2 * error / kBatch, kTolerance);
      loss += error * error / kBatch;
      mean[i] += Of(q[i])[b] / kBatch;
      square[i] += Of(q[i])[b] * Of(q[i])[b] / kBatch;
    }
    const double least = std::min(Of(q[0])[b], Of(q[1])[b]);
    least_mean += least / kBatch;
    least_square += least * least / kBatch;
    smallest = std::min(smallest, least);
    largest = std::max(largest, least);
  }
  const auto deviation = [](double m, double s) { return std::sqrt(s - m * m); };
  EXPECT_NEAR(engine_.Read(to.loss), loss, kTolerance);
  EXPECT_NEAR(engine_.Read(to.q_mean), (mean[0] + mean[1]) / 2, kTolerance);
  EXPECT_NEAR(engine_.Read(to.target_mean), target_mean, kTolerance);
  EXPECT_NEAR(engine_.Read(to.q1_mean), mean[0], kTolerance);
  EXPECT_NEAR(engine_.Read(to.q1_std), deviation(mean[0], square[0]), kTolerance);
  EXPECT_NEAR(engine_.Read(to.q2_mean), mean[1], kTolerance);
  EXPECT_NEAR(engine_.Read(to.q2_std), deviation(mean[1], square[1]), kTolerance);
  EXPECT_NEAR(engine_.Read(to.q_min_mean), least_mean, kTolerance);
  EXPECT_NEAR(engine_.Read(to.q_min_std), deviation(least_mean, least_square), kTolerance);
  EXPECT_NEAR(engine_.Read(to.q_min_min), smallest, kTolerance);
  EXPECT_NEAR(engine_.Read(to.q_min_max), largest, kTolerance);
}

TEST_F(CpuEngineTest, AnEntropyActorsLossAndItsWayToThePolicy) {
  const Array mean = Filled(kActions, 1), log_std = Filled(kActions, 2);
  const SquashedSample sample = NewSample();
  Random random(5), same(5);
  engine_.SampleSquashedGaussian(mean, log_std, &random, sample);
  const std::array q{Filled(1, 3), Filled(1, 4)}, gradients{Poisoned(1), Poisoned(1)};
  const Number temperature = Holding(0.4), loss = Holding(NAN), entropy = Holding(NAN),
               saturation = Holding(NAN);
  engine_.EntropyActorLoss(sample.log_prob, q, ActorValue::kMin, temperature, gradients, loss);
  engine_.SquashedGaussianFigures(sample, entropy, saturation);
  const Array action_gradient = Filled(kActions, 6), mean_gradient = Poisoned(kActions),
              log_std_gradient = Poisoned(kActions);
  engine_.SquashedGaussianBackward(sample, action_gradient, temperature, mean_gradient,
                                   log_std_gradient);
  engine_.Gather(&adam_, Holding(NAN));

  double expected_loss = 0, expected_entropy = 0;
  Values noise(kBatch * kActions);
  for (double& eps : noise) eps = float(same.Normal());
  Values means = Of(mean), log_stds = Of(log_std);
  const auto log_prob = [&](size_t b) {
    double sum = 0;
    for (size_t i = b * kActions; i < (b + 1) * kActions; ++i) {
      const double u = means[i] + std::exp(log_stds[i]) * noise[i];
      sum += -0.5 * noise[i] * noise[i] - log_stds[i] - 0.5 * std::log(2 * std::numbers::pi) -
             std::log(1 - std::tanh(u) * std::tanh(u));
    }
    return sum;
  };
  for (size_t b = 0; b < kBatch; ++b) {
    const double q0 = Of(q[0])[b], q1 = Of(q[1])[b];
    EXPECT_NEAR(HostValues(sample.log_prob)[b], log_prob(b), 1e-5);
    EXPECT_NEAR(HostValues(gradients[0])[b], q0 <= q1 ? -1.0 / kBatch : 0, kTolerance);
    EXPECT_NEAR(HostValues(gradients[1])[b], q0 <= q1 ? 0 : -1.0 / kBatch, kTolerance);
    expected_loss += (0.4 * log_prob(b) - std::min(q0, q1)) / kBatch;
    expected_entropy -= log_prob(b) / kBatch;
  }
  EXPECT_NEAR(engine_.Read(loss), expected_loss, 1e-5);
  EXPECT_NEAR(engine_.Read(entropy), expected_entropy, 1e-5);
  EXPECT_NEAR(engine_.Read(saturation), SaturatedShare(HostValues(sample.action)), 1e-7);
  const auto way = [&] {
    double sum = 0;
    for (size_t i = 0; i < noise.size(); ++i) {
      sum += Of(action_gradient)[i] * std::tanh(means[i] + std::exp(log_stds[i]) * noise[i]);
    }
    for (size_t b = 0; b < kBatch; ++b) sum += 0.4 / kBatch * log_prob(b);
    return sum;
  };
  for (size_t i = 0; i < noise.size(); ++i) {
    EXPECT_NEAR(HostValues(mean_gradient)[i], nn::CentralDifference(&means[i], way), 1e-5);
    EXPECT_NEAR(HostValues(log_std_gradient)[i], nn::CentralDifference(&log_stds[i], way), 1e-5);
  }
}

TEST_F(CpuEngineTest, ADeterministicActorsNoiseAndLoss) {
  const Array action = Filled(kActions, 1), mean = Filled(kActions, 2);
  const Array noisy = Poisoned(kActions);
  Random random(5), same(5);
  engine_.AddClippedNoise(action, Holding(0.8), 0.5, &random, noisy);
  Values expected;
  for (const double a : Of(action)) {
    expected.push_back(std::clamp(a + std::clamp(0.8 * same.Normal(), -0.5, 0.5), -1.0, 1.0));
  }
  EXPECT_LT(RelativeError(HostValues(noisy), expected), kTolerance);

  const Number loss = Holding(NAN), saturation = Holding(NAN);
  HostValues(action)[0] = -0.995f;
  const std::array q{Filled(1, 3), Filled(1, 4)};
  HostValues(q[1])[2] = HostValues(q[0])[2];  // a tie
  double penalty = 0;
  for (const double m : Of(mean)) penalty += 0.1 * m * m / (kBatch * kActions);
  for (const size_t critics : {1u, 2u}) {
    const std::array gradients{Poisoned(1), Poisoned(1)};
    engine_.DeterministicActorLoss(std::span(q).first(critics), mean, action, 0.1,
                                   std::span(gradients).first(critics), loss, saturation);
    engine_.Gather(&adam_, Holding(NAN));
    double expected_loss = penalty;
    for (size_t b = 0; b < kBatch; ++b) {
      const double first = Of(q[0])[b], second = critics == 1 ? INFINITY : Of(q[1])[b];
      expected_loss -= std::min(first, second) / kBatch;
      EXPECT_FLOAT_EQ(HostValues(gradients[0])[b], first <= second ? -1.f / kBatch : 0);
      if (critics == 2) {
        EXPECT_FLOAT_EQ(HostValues(gradients[1])[b], first <= second ? 0 : -1.f / kBatch);
      }
    }
    EXPECT_NEAR(engine_.Read(loss), expected_loss, kTolerance);
    EXPECT_NEAR(engine_.Read(saturation), 1.0 / (kBatch * kActions), kTolerance);
  }
}

TEST_F(CpuEngineTest, ALabelsLossMeansAndOperationsOfTheHost) {
  const Array y = Filled(3, 1), labels = Filled(3, 2), gradient = Poisoned(3);
  const Array sums = Poisoned(1);
  const Number mean_square = Holding(NAN), mean = Holding(NAN);
  engine_.LabelLoss(y, labels, 0.7f, 0.15f, gradient, mean_square);
  engine_.OnHost(std::array{y, labels}, std::array{sums}, [](const auto& in, const auto& out) {
    for (size_t b = 0; b < out[0].size(); ++b) out[0][b] = in[0][3 * b] + in[1][3 * b];
  });
  engine_.Mean(sums, mean);
  engine_.Gather(&adam_, Holding(NAN));
  double expected = 0, expected_mean = 0;
  for (size_t i = 0; i < 3 * kBatch; ++i) {
    const double error = Of(y)[i] - Of(labels)[i];
    expected += 0.15 * 0.15 * error * error / (3 * kBatch);
    EXPECT_NEAR(HostValues(gradient)[i], 2 * 0.7 * error / (3 * kBatch), kTolerance);
    if (i % 3 == 0) expected_mean += (Of(y)[i] + Of(labels)[i]) / kBatch;
  }
  EXPECT_NEAR(engine_.Read(mean_square), expected, kTolerance);
  EXPECT_NEAR(engine_.Read(mean), expected_mean, kTolerance);
}

TEST_F(CpuEngineTest, ATemperatureStepsByItsLossAndStaysAboveItsBound) {
  ParameterSet log_temperature({{"t", {1}}}, ParameterSet::Use::kTraining);
  nn::Adam adam({&log_temperature}, {.rate = 0.5});
  log_temperature.values()[0] = float(std::log(0.2));
  const Number temperature = Holding(NAN), loss = Holding(NAN);
  engine_.Begin(data_.View());
  engine_.Temperature(log_temperature, temperature);
  engine_.TemperatureLoss(temperature, Holding(-5), -3, loss);
  engine_.StepTemperature(loss, 1e-3, &log_temperature, &adam);
  engine_.Temperature(log_temperature, temperature);
  EXPECT_TRUE(engine_.EndAndWait().finite);
  EXPECT_NEAR(engine_.Read(loss), 0.2 * (-5 + 3), kTolerance);
  EXPECT_NEAR(engine_.Read(temperature), 0.2 * std::exp(0.5),
              1e-5);  // entropy is too low: it rises
  engine_.Begin(data_.View());
  engine_.StepTemperature(Holding(1), 0.4, &log_temperature, &adam);
  engine_.Temperature(log_temperature, temperature);
  engine_.End();
  EXPECT_NEAR(engine_.Read(temperature), 0.4, 1e-5);
}

// Losses of replicas are means over their rows; after Gather the numbers are those of the batch.
TEST(CpuEngineReplicas, NumbersAfterGatherAreOfTheWholeBatch) {
  constexpr int kReplicas = 2, kRows = 5;  // shares of two and of three rows
  const RandomBatch data(SmallSpec(), kRows, 3);
  nn::Exchange exchange(kReplicas, kRows);
  nn::Team team(kReplicas);
  std::deque<nn::Replica> replicas;
  std::deque<CpuEngine> engines;
  std::deque<ParameterSet> sets;
  std::deque<nn::Adam> adams;
  for (int rank = 0; rank < kReplicas; ++rank) {
    nn::Replica* replica = &replicas.emplace_back(&exchange, rank);
    CpuEngine& engine = engines.emplace_back(nn::Precision::kF32, kRows, replica);
    ParameterSet& set = sets.emplace_back(std::vector<nn::ParameterSpec>{{"w", {3}}},
                                          ParameterSet::Use::kTraining, replica);
    adams.emplace_back(std::vector{&set}, nn::Adam::Options{.rate = 0.1}, engine.modules());
  }
  std::array<double, kReplicas> mean{}, loss{};
  std::array<std::vector<float>, kReplicas> rewards;
  team.Run([&](int rank) {
    CpuEngine& engine = engines[size_t(rank)];
    const Number own_mean = engine.NewNumber(), squares = engine.NewNumber();
    const CriticNumbers numbers = NewCriticNumbers(/*critics=*/1, &engine);
    engine.Begin(data.View());
    const Transitions own = engine.Take(data.View());
    engine.Mean(own.reward, own_mean);
    const Array q[] = {own.reward}, gradients[] = {engine.NewArray(1)};
    engine.CriticLoss(q, own.bootstrap, /*rows=*/{}, gradients, numbers);
    engine.Gather(&adams[size_t(rank)], squares);
    engine.End();
    const Array put = engine.NewArray(1);
    engine.Put(data.View().reward, put);
    rewards[size_t(rank)] = engine.ReadRows(put);
    EXPECT_EQ(rewards[size_t(rank)], engine.ReadRows(own.reward));
    mean[size_t(rank)] = engine.Read(own_mean);
    loss[size_t(rank)] = engine.Read(numbers.loss);
  });
  const BatchView view = data.View();
  EXPECT_THAT(rewards, ElementsAre(testing::SizeIs(2), testing::SizeIs(3)));
  double expected_mean = 0, expected_loss = 0;
  for (size_t b = 0; b < kRows; ++b) {
    expected_mean += double(view.reward[b]) / kRows;
    expected_loss += std::pow(double(view.reward[b]) - view.bootstrap[b], 2) / kRows;
  }
  for (size_t rank = 0; rank < kReplicas; ++rank) {
    EXPECT_NEAR(mean[rank], expected_mean, CpuEngineTest::kTolerance);
    EXPECT_NEAR(loss[rank], expected_loss, CpuEngineTest::kTolerance);
  }
}

}  // namespace
}  // namespace shoal::learner
