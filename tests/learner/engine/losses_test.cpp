// SPDX-License-Identifier: Apache-2.0
#include "learner/engine/losses.h"

#include <gmock/gmock.h>

#include <array>

#include "tests/common/nn/gradient_check.h"

namespace shoal::learner {
namespace {

using nn::CentralDifference;
using nn::RandomValues;
using nn::ToFloats;
using nn::reference::Values;

TEST(TdTargets, TakeTheSmallerHeadLessTheEntropyTermAndNothingAfterATerminal) {
  const float reward[2] = {0.5f, -1.f}, bootstrap[2] = {1.f, 0.f};
  const float q1[2] = {3.f, 100.f}, q2[2] = {4.f, 100.f}, log_prob[2] = {2.f, 50.f};
  const float* const heads[] = {q1, q2};
  const float* const swapped[] = {q2, q1};
  float y[2];
  TdTargets(2, {reward, bootstrap, heads, log_prob},
            {.reward_scale = 10, .discount = 0.5f, .temperature = 0.25f}, y);
  EXPECT_FLOAT_EQ(y[0], 5.f + 0.5f * (3.f - 0.25f * 2.f));
  EXPECT_FLOAT_EQ(y[1], -10.f);
  TdTargets(2, {reward, bootstrap, swapped, log_prob},
            {.reward_scale = 10, .discount = 0.5f, .temperature = 0.25f}, y);
  EXPECT_FLOAT_EQ(y[0], 6.25f);
}

TEST(TdTargets, CutTheSmallerHeadOffBeforeTheEntropyTerm) {
  const float reward[3] = {-1.f, -1.f, 0.f}, bootstrap[3] = {1.f, 1.f, 1.f};
  const float q1[3] = {-9.f, 2.f, -3.f}, q2[3] = {-8.f, 3.f, -2.f}, log_prob[3] = {2.f, 2.f, 2.f};
  const TargetRates rates{
      .reward_scale = 2, .discount = 0.5f, .temperature = 0.25f, .bounds = {.low = -4, .high = 0}};
  const float* const heads[] = {q1, q2};
  float y[3];
  TdTargets(3, {reward, bootstrap, heads, log_prob}, rates, y);
  EXPECT_FLOAT_EQ(y[0], -2.f + 0.5f * (-4.f - 0.5f));
  EXPECT_FLOAT_EQ(y[1], -2.f + 0.5f * (0.f - 0.5f));
  EXPECT_FLOAT_EQ(y[2], 0.5f * (-3.f - 0.5f));
  TdTargets(3, {reward, bootstrap, heads}, rates, y);
  EXPECT_FLOAT_EQ(y[0], -2.f + 0.5f * -4.f);
  EXPECT_FLOAT_EQ(y[1], -2.f);
  EXPECT_FLOAT_EQ(y[2], 0.5f * -3.f);
}

TEST(AverageCopies, GivesEveryCopyTheMeanOfItsTransition) {
  float y[6] = {1, 2, 6, -1, -3, 1};
  AverageCopies(6, 3, /*shifts=*/0, y);
  EXPECT_THAT(y, ::testing::ElementsAre(3, 3, 3, -1, -1, -1));
  float alone[3] = {1, 2, 3};
  AverageCopies(3, 1, /*shifts=*/0, alone);
  EXPECT_THAT(alone, ::testing::ElementsAre(1, 2, 3));
}

TEST(AverageCopies, CountsEachShiftOnce) {
  float y[8] = {1, 2, 7, 9, -1, -3, 0, 5};
  AverageCopies(8, 4, /*shifts=*/2, y);
  EXPECT_THAT(y, ::testing::ElementsAre(1.5f, 1.5f, 1.5f, 1.5f, -2, -2, -2, -2));
  float first[4] = {1, 2, 3, 4};
  AverageCopies(4, 2, /*shifts=*/1, first);
  EXPECT_THAT(first, ::testing::ElementsAre(1, 1, 3, 3));
}

TEST(CriticLoss, IsTheSumOverHeadsOfTheMeanSquare) {
  const float q0[2] = {1.f, 2.f}, q1[2] = {0.f, 5.f}, y[2] = {1.f, 4.f};
  const float* const q[] = {q0, q1};
  const CriticLoss loss = CriticLossForward(2, q, y);
  EXPECT_FLOAT_EQ(loss.loss, (0.f + 4.f) / 2 + (1.f + 1.f) / 2);
  EXPECT_FLOAT_EQ(loss.q_mean, 2.f);
  EXPECT_FLOAT_EQ(loss.target_mean, 2.5f);
}

TEST(CriticLoss, GradientIsTheCentralDifference) {
  constexpr int kSamples = 5;
  Values q0 = RandomValues(kSamples, 1);
  const Values q1 = RandomValues(kSamples, 2), y = RandomValues(kSamples, 3);
  const auto loss = [&] {
    double sum = 0;
    for (size_t b = 0; b < kSamples; ++b) {
      sum += (q0[b] - y[b]) * (q0[b] - y[b]) + (q1[b] - y[b]) * (q1[b] - y[b]);
    }
    return sum / kSamples;
  };
  const std::vector<float> first = ToFloats(q0), second = ToFloats(q1);
  const float* const q[] = {first.data(), second.data()};
  EXPECT_NEAR(CriticLossForward(kSamples, q, ToFloats(y).data()).loss, loss(), 1e-6);
  std::vector<float> gradient(kSamples);
  CriticLossBackward(kSamples, ToFloats(q0).data(), ToFloats(y).data(), gradient.data());
  for (size_t b = 0; b < kSamples; ++b) {
    EXPECT_NEAR(gradient[b], CentralDifference(&q0[b], loss), 1e-6);
  }
}

// Errors of both sizes, on both sides of 1.
TEST(CriticLoss, OfWeightedRowsAndOfHuberHasTheCentralDifferenceAsGradient) {
  constexpr int kSamples = 6;
  Values q0{0.2, -0.5, 3, -4, 1.2, 0.9};
  const Values q1 = RandomValues(kSamples, 2), y = RandomValues(kSamples, 3);
  const Values weights{1, 0.5, 0.25, 0.125, 0.75, 0.01};
  const std::vector<float> of_weights = ToFloats(weights);
  for (const bool weighted : {false, true}) {
    for (const bool huber : {false, true}) {
      const auto loss = [&] {
        double sum = 0;
        for (size_t b = 0; b < kSamples; ++b) {
          for (const double q : {q0[b], q1[b]}) {
            const double error = std::abs(q - y[b]);
            const double of_row = huber && error > 1 ? 2 * error - 1 : error * error;
            sum += (weighted ? weights[b] : 1) * of_row;
          }
        }
        return sum / kSamples;
      };
      const RowLoss rows{weighted ? of_weights.data() : nullptr, huber};
      const std::vector<float> first = ToFloats(q0), second = ToFloats(q1);
      const float* const q[] = {first.data(), second.data()};
      EXPECT_NEAR(CriticLossForward(kSamples, q, ToFloats(y).data(), rows).loss, loss(), 1e-6);
      std::vector<float> gradient(kSamples);
      CriticLossBackward(kSamples, first.data(), ToFloats(y).data(), gradient.data(), rows);
      for (size_t b = 0; b < kSamples; ++b) {
        EXPECT_NEAR(gradient[b], CentralDifference(&q0[b], loss), 1e-6) << b;
      }
    }
  }
}

TEST(CriticErrors, AreTheLargestOfAllCritics) {
  const float q0[3] = {1, 2, -3}, q1[3] = {4, 2, 0}, y[3] = {2, 2.5f, 1};
  const float* const q[] = {q0, q1};
  float errors[3];
  CriticErrors(3, q, y, errors);
  EXPECT_THAT(errors, ::testing::ElementsAre(2, 0.5f, 4));
}

TEST(TdTargets, TakeTheSmallestOfAnyNumberOfHeads) {
  const float reward[2] = {0, 0}, bootstrap[2] = {1, 1};
  const float q1[2] = {3, 9}, q2[2] = {4, 7}, q3[2] = {2, 8};
  float y[2];
  const auto targets = [&](std::span<const float* const> heads) {
    TdTargets(2, {reward, bootstrap, heads}, {.reward_scale = 1, .discount = 1}, y);
    return std::vector(y, y + 2);
  };
  EXPECT_THAT(targets(std::array<const float*, 3>{q1, q2, q3}), ::testing::ElementsAre(2, 7));
  EXPECT_THAT(targets(std::array<const float*, 1>{q1}), ::testing::ElementsAre(3, 9));
}

TEST(ActorLoss, IsTheMeanOfEntropyTermLessTheSmallestValueOrTheMeanValue) {
  const float log_prob[2] = {2.f, -1.f}, q0[2] = {3.f, 7.f}, q1[2] = {4.f, 5.f}, q2[2] = {8, 6};
  const float* const two[] = {q0, q1};
  const float* const three[] = {q2, q0, q1};
  EXPECT_FLOAT_EQ(ActorLossForward(2, log_prob, two, ActorValue::kMin, 0.5f),
                  ((1.f - 3.f) + (-0.5f - 5.f)) / 2);
  EXPECT_FLOAT_EQ(ActorLossForward(2, log_prob, three, ActorValue::kMin, 0.5f),
                  ((1.f - 3.f) + (-0.5f - 5.f)) / 2);
  EXPECT_FLOAT_EQ(ActorLossForward(2, log_prob, three, ActorValue::kMean, 0.5f),
                  ((1.f - 5.f) + (-0.5f - 6.f)) / 2);
}

TEST(ActorLoss, GradientGoesToTheSmallestHeadAloneOrToAllHeads) {
  const float q0[4] = {3, 7, 1, 4}, q1[4] = {4, 5, 1, 2}, q2[4] = {5, 5, 3, 1};
  const float* const q[] = {q0, q1, q2};
  const auto gradients = [&](ActorValue value) {
    std::vector<std::vector<float>> of_heads(3, std::vector<float>(4, NAN));
    const std::array<float*, 3> to{of_heads[0].data(), of_heads[1].data(), of_heads[2].data()};
    ActorLossBackward(4, q, value, to);
    return of_heads;
  };
  const float share = -1.f / 4, third = -1.f / 12;
  EXPECT_THAT(gradients(ActorValue::kMin),
              ::testing::ElementsAre(::testing::ElementsAre(share, 0, share, 0),
                                     ::testing::ElementsAre(0, share, 0, 0),
                                     ::testing::ElementsAre(0, 0, 0, share)));
  EXPECT_THAT(gradients(ActorValue::kMean),
              ::testing::Each(::testing::Each(::testing::FloatEq(third))));
}

TEST(LabelLoss, GradientIsTheCentralDifferenceOfTheWeightedMeanSquare) {
  constexpr size_t kNumbers = 6;
  constexpr float kWeight = 0.7f;
  Values y = RandomValues(kNumbers, 1);
  const Values labels = RandomValues(kNumbers, 2);
  const auto squares = [&] {
    double sum = 0;
    for (size_t i = 0; i < kNumbers; ++i) sum += (y[i] - labels[i]) * (y[i] - labels[i]);
    return sum;
  };
  std::vector<float> gradient(kNumbers, NAN);
  EXPECT_NEAR(LabelLoss(ToFloats(y), ToFloats(labels), kWeight, gradient), squares(), 1e-6);
  for (size_t i = 0; i < kNumbers; ++i) {
    EXPECT_NEAR(gradient[i],
                CentralDifference(&y[i], [&] { return kWeight * squares() / kNumbers; }), 1e-6);
  }
}

TEST(SaturatedShare, CountsBothEnds) {
  EXPECT_EQ(SaturatedShare(std::vector{0.999f, -0.995f, 0.99f, 0.f}), 0.5);
}

TEST(Summarise, IsOfAllNumbers) {
  const Summary summary = Summarise(std::vector{1.f, 2.f, -6.f});
  EXPECT_EQ(summary.mean, -1);
  EXPECT_DOUBLE_EQ(summary.deviation, std::sqrt((4 + 9 + 25) / 3.0));
  EXPECT_EQ(summary.least, -6);
  EXPECT_EQ(summary.most, 2);
}

TEST(TemperatureLoss, IsNegativeWhereEntropyIsTooLowSoThatTheTemperatureRises) {
  EXPECT_FLOAT_EQ(TemperatureLoss(0.2f, /*entropy=*/-5.f, /*target_entropy=*/-3.f), -0.4f);
  EXPECT_FLOAT_EQ(TemperatureLoss(0.2f, -1.f, -3.f), 0.4f);
}

}  // namespace
}  // namespace shoal::learner
