// SPDX-License-Identifier: Apache-2.0
#include "common/nn/parameter_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "common/base/error.h"
#include "common/base/random.h"
#include "common/nn/orthogonal.h"
#include "common/nn/tensor_words.h"

namespace shoal::nn {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

ParameterSet MakeSet() {
  return ParameterSet({{"a.weight", {3, 5}, {Start::Kind::kOrthogonal, 2}},
                       {"a.norm.weight", {3}, {Start::Kind::kOnes}},
                       {"b.bias", {7}}},
                      ParameterSet::Use::kTraining);
}

TEST(ParameterSet, ParametersAreApartAndAligned) {
  ParameterSet set = MakeSet();
  const float* base = set.values();
  EXPECT_EQ(set.Find("a.weight").value() - base, 0);
  EXPECT_EQ(set.Find("a.norm.weight").value() - base, 16);
  EXPECT_EQ(set.Find("b.bias").value() - base, 32);
  EXPECT_EQ(set.size(), 48);
  EXPECT_EQ(set.OffsetOf("b."), 32);
  EXPECT_EQ(set.OffsetOf("nothing"), set.size());
}

TEST(ParameterSet, InitialisesAsEachStartSaysByNameAndSeed) {
  ParameterSet one = MakeSet(), same = MakeSet(), other = MakeSet();
  one.Initialise(1);
  same.Initialise(1);
  other.Initialise(2);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(one.Find("a.norm.weight").value()[i], 1.f);
  for (int i = 0; i < 7; ++i) EXPECT_EQ(one.Find("b.bias").value()[i], 0.f);
  double squares = 0;
  for (int j = 0; j < 5; ++j) squares += std::pow(one.Find("a.weight").value()[j], 2);
  EXPECT_NEAR(squares, 4, 1e-5) << "a row of an orthogonal weight of gain 2";
  const size_t bytes = size_t(one.size()) * sizeof(float);
  EXPECT_EQ(std::memcmp(one.values(), same.values(), bytes), 0);
  EXPECT_NE(std::memcmp(one.values(), other.values(), bytes), 0);
}

TEST(ParameterSet, AUniformStartFillsItsIntervalAndNoMore) {
  constexpr int kSamples = 10'000;
  ParameterSet set({{"w", {kSamples}, {Start::Kind::kUniform, 0.25}}},
                   ParameterSet::Use::kInference);
  set.Initialise(4);
  const float* w = set.values();
  const auto [low, high] = std::minmax_element(w, w + kSamples);
  EXPECT_GE(*low, -0.25f);
  EXPECT_LE(*high, 0.25f);
  double sum = 0, squares = 0;
  for (int i = 0; i < kSamples; ++i) {
    sum += w[i];
    squares += double(w[i]) * w[i];
  }
  // Mean 0, variance 0.25^2 / 3; five standard errors.
  EXPECT_NEAR(sum / kSamples, 0, 5 * 0.25 / std::sqrt(3.0 * kSamples));
  EXPECT_NEAR(squares / kSamples, 0.0625 / 3, 5 * 0.0625 * std::sqrt(4.0 / 45 / kSamples));
}

TEST(ParameterSet, ANormalStartHasItsDeviation) {
  constexpr int kSamples = 10'000;
  ParameterSet set({{"w", {kSamples}, {Start::Kind::kNormal, 0.25}}},
                   ParameterSet::Use::kInference);
  set.Initialise(4);
  double sum = 0, squares = 0;
  for (int i = 0; i < kSamples; ++i) {
    sum += set.values()[i];
    squares += double(set.values()[i]) * set.values()[i];
  }
  // Five standard errors; the square of a normal number has variance 2.
  EXPECT_NEAR(sum / kSamples, 0, 5 * 0.25 / std::sqrt(double(kSamples)));
  EXPECT_NEAR(squares / kSamples, 0.0625, 5 * 0.0625 * std::sqrt(2.0 / kSamples));
}

TEST(ParameterSet, StatisticsLieBehindWhatIsTrainedAndHaveNoGradient) {
  ParameterSet set({{"a.weight", {3}},
                    {"a.running_mean", {3}, {}, /*statistic=*/true},
                    {"b.weight", {5}, {Start::Kind::kOnes}}},
                   ParameterSet::Use::kTraining);
  set.Initialise(1);
  EXPECT_EQ(set.size(), 48);
  EXPECT_EQ(set.trained_size(), 32);
  const float* base = set.values();
  EXPECT_EQ(set.Find("b.weight").value() - base, 16);
  EXPECT_EQ(set.Find("a.running_mean").value() - base, 32);
  EXPECT_EQ(set.Find("a.running_mean").next_value() - set.next_values(), 32);
  EXPECT_EQ(set.Find("a.running_mean").gradient(), nullptr);
  EXPECT_NE(set.Find("b.weight").gradient(), nullptr);
  EXPECT_EQ(set.Find("b.weight").value()[0], 1.f);

  TensorMap all, trained;
  set.Export(&all);
  set.ExportTrained(set.gradients(), "g.", &trained);
  EXPECT_TRUE(all.contains("a.running_mean"));
  EXPECT_EQ(trained.size(), 2u);
  EXPECT_FALSE(trained.contains("g.a.running_mean"));
}

TEST(ParameterSet, ExportThenImportGivesTheSameValues) {
  ParameterSet from = MakeSet(), to = MakeSet();
  from.Initialise(3);
  TensorMap tensors;
  from.Export(from.values(), "x.", &tensors);
  EXPECT_EQ(tensors.at("x.a.weight").shape, (std::vector<int64_t>{3, 5}));
  to.Import(tensors, "x.", "test", to.values());
  EXPECT_EQ(std::memcmp(from.values(), to.values(), size_t(from.size()) * sizeof(float)), 0);
}

TEST(ParameterSet, ImportTakesBf16) {
  ParameterSet from = MakeSet(), to = MakeSet();
  from.Initialise(3);
  TensorMap tensors;
  from.Export(from.values(), "", &tensors);
  to.Import(ToBf16(tensors), "", "test", to.values());
  for (int64_t i = 0; i < from.size(); ++i) {
    EXPECT_NEAR(to.values()[i], from.values()[i], 0.004 * std::abs(from.values()[i]));
  }
}

TEST(ParameterSet, WhatIsBorrowedStaysInTheTensors) {
  ParameterSet from = MakeSet();
  from.Initialise(3);
  TensorMap tensors;
  from.Export(&tensors);
  const TensorMap rounded = ToBf16(tensors);
  ParameterSet set({{"a.weight", {3, 5}}, {"a.norm.weight", {3}}, {"b.bias", {7}}},
                   ParameterSet::Use::kBorrowing);
  EXPECT_EQ(set.size(), 32) << "of the vectors alone";
  EXPECT_EQ(set.Find("a.weight").plain().data, nullptr) << "nothing yet";
  for (const bool bf16 : {true, false}) {
    const TensorMap& loaded = bf16 ? rounded : tensors;
    set.Borrow(loaded, "test");
    EXPECT_EQ(set.Find("a.weight").plain().data, loaded.at("a.weight").data.data());
    EXPECT_EQ(set.Find("a.weight").plain().bf16, bf16);
    EXPECT_EQ(set.Find("a.norm.weight").value()[2], 1.f);
  }
  EXPECT_TRUE(set.Find("a.weight").borrowed());
  EXPECT_FALSE(set.Find("b.bias").borrowed());
  TensorMap wrong = rounded;
  wrong.at("a.norm.weight").data.assign(6, 0);
  wrong.erase("b.bias");
  EXPECT_THROW(set.Borrow(wrong, "test"), Error);
  EXPECT_EQ(set.Find("a.weight").plain().data, tensors.at("a.weight").data.data());
  EXPECT_EQ(set.Find("a.norm.weight").value()[0], 1.f);
}

TEST(ParameterSet, ImportNamesWhatIsMissingOrMisshaped) {
  ParameterSet set = MakeSet();
  TensorMap tensors;
  set.Export(set.values(), "", &tensors);
  const auto import = [&] { set.Import(tensors, "", "weights 7", set.values()); };

  tensors.at("b.bias").shape = {7, 1};
  EXPECT_THAT(import, ThrowsMessage<Error>(AllOf(HasSubstr("weights 7"), HasSubstr("b.bias"),
                                                 HasSubstr("7x1"), HasSubstr("expected 7"))));
  tensors.at("b.bias").shape = {7};
  tensors.at("b.bias").dtype = "U64";
  EXPECT_THAT(import, ThrowsMessage<Error>(AllOf(HasSubstr("b.bias"), HasSubstr("U64"))));
  tensors.at("b.bias").dtype = "F32";
  tensors.at("b.bias").data.pop_back();
  EXPECT_THAT(import, ThrowsMessage<Error>(AllOf(HasSubstr("b.bias"), HasSubstr("27 bytes"))));
  tensors.erase("b.bias");
  EXPECT_THAT(import, ThrowsMessage<Error>(AllOf(HasSubstr("b.bias"), HasSubstr("missing"))));
}

TEST(ParameterSet, ARefusedImportWritesNothing) {
  ParameterSet set = MakeSet(), other = MakeSet();
  set.Initialise(1);
  other.Initialise(2);
  TensorMap tensors;
  other.Export(&tensors);
  tensors.erase("b.bias");
  const std::vector<float> before(set.values(), set.values() + set.size());
  EXPECT_THROW(set.Import(tensors, "", "test", set.values()), Error);
  EXPECT_EQ(std::vector<float>(set.values(), set.values() + set.size()), before);
}

TEST(TensorCounter, GoesThroughTensorsUnchangedAndOthersAreRefused) {
  TensorMap tensors;
  ExportCounter("n", 0x0123456789abcdefu, &tensors);
  EXPECT_EQ(ImportCounter(tensors, "n", "test"), 0x0123456789abcdefu);
  EXPECT_THROW(ImportCounter(tensors, "m", "test"), Error);
  tensors.at("n").dtype = "F32";
  EXPECT_THROW(ImportCounter(tensors, "n", "test"), Error);
}

// Rows of a wide matrix, columns of a tall one, are orthogonal and of length `gain`.
void ExpectOrthogonal(int64_t rows, int64_t cols, double gain) {
  Random random(5);
  std::vector<float> w(size_t(rows * cols));
  FillOrthogonal(rows, cols, gain, &random, w.data());
  const bool wide = cols >= rows;
  const int64_t n = std::min(rows, cols), length = std::max(rows, cols);
  for (int64_t a = 0; a < n; ++a) {
    for (int64_t b = 0; b <= a; ++b) {
      double dot = 0;
      for (int64_t k = 0; k < length; ++k) {
        const int64_t i = wide ? a * cols + k : k * cols + a;
        const int64_t j = wide ? b * cols + k : k * cols + b;
        dot += double(w[size_t(i)]) * w[size_t(j)];
      }
      ASSERT_NEAR(dot, a == b ? gain * gain : 0, 1e-5) << a << " " << b;
    }
  }
}

TEST(Orthogonal, RowsOrColumnsAreOrthogonalAndOfTheGainsLength) {
  ExpectOrthogonal(5, 17, 1.0);
  ExpectOrthogonal(17, 5, std::sqrt(2.0));
  ExpectOrthogonal(8, 8, 1.0);
  ExpectOrthogonal(1, 9, 1.0);
}

// Without the correction of signs, QR gives a matrix whose diagonal of R has one sign: entries of
// the first column would be biased.
TEST(Orthogonal, FirstEntryIsPositiveAsOftenAsNegative) {
  constexpr int kDraws = 2'000;
  Random random(11);
  int positive = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    float w[4];
    FillOrthogonal(2, 2, 1.0, &random, w);
    positive += w[0] > 0;
  }
  EXPECT_NEAR(positive, 0.5 * kDraws, 5 * std::sqrt(kDraws * 0.25));
}

}  // namespace
}  // namespace shoal::nn
