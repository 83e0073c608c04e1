// SPDX-License-Identifier: Apache-2.0
#include "common/nn/adam.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "common/base/error.h"
#include "common/base/random.h"
#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

constexpr double kRate = 0.01;

// More than one unit of parallel work, and a remainder.
constexpr int64_t kSize = 10'007;

void FillGradient(ParameterSet& set, uint64_t key) {
  Random random(key);
  float* gradient = set.Find("w").gradient();
  for (int64_t i = 0; i < kSize; ++i) gradient[i] = float(random.Normal());
}

std::vector<float> WeightsOf(ParameterSet& set) {
  const float* value = set.Find("w").value();
  return {value, value + kSize};
}

TEST(Adam, FollowsTheFormulaOverSeveralSteps) {
  ParameterSet set({{"w", {kSize}}}, ParameterSet::Use::kTraining);
  Adam adam({&set}, {.rate = kRate});
  std::vector<double> m(kSize), v(kSize), w(kSize);
  for (int t = 1; t <= 5; ++t) {
    FillGradient(set, uint64_t(t));
    const float* gradient = set.Find("w").gradient();
    for (size_t i = 0; i < size_t(kSize); ++i) {
      const double g = gradient[i];
      m[i] = 0.9 * m[i] + 0.1 * g;
      v[i] = 0.999 * v[i] + 0.001 * g * g;
      w[i] -= kRate * (m[i] / (1 - std::pow(0.9, t))) /
              (std::sqrt(v[i] / (1 - std::pow(0.999, t))) + 1e-8);
    }
    adam.Step();
  }
  const std::vector<float> values = WeightsOf(set);
  for (size_t i = 0; i < values.size(); ++i) ASSERT_NEAR(values[i], w[i], 1e-6) << i;
  EXPECT_EQ(adam.steps(), 5u);
}

TEST(Adam, FirstStepMovesEveryValueByTheRateAgainstTheGradient) {
  ParameterSet set({{"w", {2}}}, ParameterSet::Use::kTraining);
  Adam adam({&set}, {.rate = kRate});
  set.Find("w").gradient()[0] = 1e-3f;
  set.Find("w").gradient()[1] = -1e3f;
  adam.Step();
  EXPECT_NEAR(set.Find("w").value()[0], -kRate, 1e-6);
  EXPECT_NEAR(set.Find("w").value()[1], kRate, 1e-6);
}

TEST(Adam, UndoTakesAStepBackExactly) {
  ParameterSet set({{"w", {kSize}}}, ParameterSet::Use::kTraining);
  Adam adam({&set}, {.rate = kRate});
  FillGradient(set, 1);
  adam.Step();
  TensorMap before, after;
  adam.Export("g", &before);
  const std::vector<float> values = WeightsOf(set);
  FillGradient(set, 2);
  adam.Step();
  EXPECT_NE(WeightsOf(set), values);
  adam.Undo();
  adam.Export("g", &after);
  EXPECT_EQ(WeightsOf(set), values);
  for (const auto& [name, tensor] : before) EXPECT_EQ(tensor.data, after.at(name).data) << name;
}

TEST(Adam, StepIsTheSameForAnyNumberOfThreads) {
  std::vector<std::vector<float>> results;
  for (const int threads : {1, 3}) {
    const ThreadScope scope(threads);
    ParameterSet set({{"w", {kSize}}}, ParameterSet::Use::kTraining);
    Adam adam({&set}, {.rate = kRate});
    FillGradient(set, 1);
    adam.Step();
    results.push_back(WeightsOf(set));
  }
  EXPECT_EQ(results[0], results[1]);
}

TEST(Adam, ImportContinuesWhereExportLeftOff) {
  ParameterSet a({{"w", {kSize}}}, ParameterSet::Use::kTraining);
  ParameterSet b({{"w", {kSize}}}, ParameterSet::Use::kTraining);
  Adam adam_a({&a}, {.rate = kRate}), adam_b({&b}, {.rate = kRate});
  FillGradient(a, 1);
  adam_a.Step();
  TensorMap tensors;
  adam_a.Export("g", &tensors);
  a.Export(a.values(), "", &tensors);
  adam_b.Import(tensors, "g", "test");
  b.Import(tensors, "", "test", b.values());
  FillGradient(a, 2);
  FillGradient(b, 2);
  adam_a.Step();
  adam_b.Step();
  EXPECT_EQ(WeightsOf(a), WeightsOf(b));
}

TEST(Adam, ImportRefusesAMissingMoment) {
  ParameterSet set({{"w", {kSize}}}, ParameterSet::Use::kTraining);
  Adam adam({&set}, {.rate = kRate});
  TensorMap tensors;
  adam.Export("g", &tensors);
  tensors.erase("adam.v.w");
  EXPECT_THAT([&] { adam.Import(tensors, "g", "file.safetensors"); },
              testing::ThrowsMessage<Error>(testing::AllOf(testing::HasSubstr("file.safetensors"),
                                                           testing::HasSubstr("adam.v.w"))));
}

TEST(Adam, StepsSeveralSetsAsItWouldOne) {
  ParameterSet one({{"w", {kSize}}}, ParameterSet::Use::kTraining);
  ParameterSet a({{"w", {kSize}}}, ParameterSet::Use::kTraining);
  ParameterSet b({{"v", {kSize}}}, ParameterSet::Use::kTraining);
  Adam alone({&one}, {.rate = kRate}), both({&a, &b}, {.rate = kRate});
  for (uint64_t t = 1; t <= 2; ++t) {
    FillGradient(one, t);
    FillGradient(a, t);
    std::copy_n(a.gradients(), a.size(), b.gradients());
    alone.Step();
    both.Step();
  }
  EXPECT_EQ(WeightsOf(a), WeightsOf(one));
  EXPECT_EQ(std::vector<float>(b.values(), b.values() + kSize), WeightsOf(one));
  both.Undo();
  EXPECT_EQ(both.steps(), 1u);
  EXPECT_EQ(std::vector<float>(b.values(), b.values() + kSize), WeightsOf(a));
  EXPECT_NE(WeightsOf(a), WeightsOf(one));
  EXPECT_DOUBLE_EQ(both.GatherGradients(), 2 * alone.GatherGradients());
}

// Replicas meet once for the gradients and the step.
TEST(Adam, GatheringGradientsChangesNothingBeforeTheStep) {
  ParameterSet set({{"w", {kSize}}}, ParameterSet::Use::kTraining);
  Adam adam({&set}, {.rate = kRate});
  FillGradient(set, 1);
  adam.Step();
  const std::vector<float> before = WeightsOf(set);
  TensorMap moments, same;
  adam.Export("g", &moments);
  FillGradient(set, 2);
  adam.GatherGradients();
  EXPECT_EQ(WeightsOf(set), before);
  adam.Export("g", &same);
  for (const auto& [name, tensor] : moments) EXPECT_EQ(same.at(name).data, tensor.data) << name;
  adam.Step();
  EXPECT_NE(WeightsOf(set), before);
  EXPECT_EQ(adam.steps(), 2u);
}

TEST(Adam, EpsilonAndRateAreThoseAskedFor) {
  ParameterSet set({{"w", {1}}}, ParameterSet::Use::kTraining);
  Adam adam({&set}, {.rate = kRate, .epsilon = 0.5});
  set.gradients()[0] = 0.25f;  // the first step moves by rate g / (|g| + eps)
  adam.Step();
  EXPECT_NEAR(set.values()[0], -kRate * 0.25 / 0.75, 1e-7);
  adam.Undo();
  adam.set_rate_factor(2);
  adam.Step();
  EXPECT_NEAR(set.values()[0], -2 * kRate * 0.25 / 0.75, 1e-7);
}

TEST(Adam, ClipsTheNormOfAllGradientsTogether) {
  ParameterSet a({{"a", {2}}}, ParameterSet::Use::kTraining);
  ParameterSet b({{"b", {1}}}, ParameterSet::Use::kTraining);
  a.gradients()[0] = 2;
  a.gradients()[1] = -3;
  b.gradients()[0] = 6;  // norm 7
  Adam({&a, &b}, {.rate = kRate}).Step();
  Adam({&a, &b}, {.rate = kRate, .max_norm = 8}).Step();
  EXPECT_EQ(b.gradients()[0], 6.f);
  Adam({&a, &b}, {.rate = kRate, .max_norm = 3.5}).Step();
  EXPECT_NEAR(a.gradients()[0], 1, 1e-6);
  EXPECT_NEAR(a.gradients()[1], -1.5, 1e-6);
  EXPECT_NEAR(b.gradients()[0], 3, 1e-6);
}

TEST(MoveTowards, CoversTheGivenShareOfTheDistance) {
  const std::vector<float> online(kSize, 3.f);
  std::vector<float> target(kSize, 1.f);
  MoveTowards(0.25f, online.data(), kSize, target.data());
  EXPECT_EQ(target, std::vector<float>(kSize, 1.5f));
}

TEST(SumOfSquares, DoesNotOverflowWhereFloatWould) {
  const std::vector<float> values{3e30f, 4e30f};
  EXPECT_NEAR(SumOfSquares(values.data(), 2) / 25e60, 1, 1e-6);
}

}  // namespace
}  // namespace shoal::nn
