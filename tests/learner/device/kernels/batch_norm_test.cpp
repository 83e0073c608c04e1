// SPDX-License-Identifier: Apache-2.0
#include "learner/device/kernels/batch_norm.h"

#include <cmath>
#include <vector>

#include "tests/learner/device/kernels/kernel_fixture.h"

namespace shoal::learner::kernels {
namespace {

using Doubles = std::vector<double>;

class BatchNormKernels : public KernelTest {
 protected:
  // Two groups of channels; several parts of sums; blocks with a part of their rows; three channels
  // of padding.
  static constexpr size_t kRows = 150, kChannels = 37, kPadded = 40, kNumbers = kRows * kPadded;

  BatchNormKernels() {
    for (size_t i = 0; i < kNumbers; ++i) {
      if (i % kPadded >= kChannels) x_[i] = dy_[i] = skip_[i] = 0;
    }
    for (size_t c = kChannels; c < kPadded; ++c) {
      weight_[c] = bias_[c] = running_mean_[c] = running_variance_[c] = 0;
    }
  }

  ColumnSums NewSums(int sums) {
    ColumnSums result{.rows = kRows, .columns = kPadded};
    EXPECT_GT(result.parts(), 1);
    result.partials = Out(size_t(sums) * size_t(result.PartialsSize()));
    result.finished = Counters(size_t(result.groups()));
    return result;
  }

  void Measure(const Source& x) {
    constexpr double kN = kRows;
    Run(ChannelMeans{.sums = NewSums(1), .x = x, .inverse = float(1 / kN), .mean = mean_});
    Run(ChannelVariances{.sums = NewSums(1),
                         .x = x,
                         .inverse = float(1 / kN),
                         .unbiased = float(kN / (kN - 1)),
                         .mean = mean_,
                         .variance = variance_,
                         .running_mean = In(running_mean_),
                         .running_variance = In(running_variance_),
                         .next_mean = next_mean_,
                         .next_variance = next_variance_});
  }

  void Forward(const Source& x, const Source& skip, Activation activation, const Target& y) {
    Run(BatchNormForward{.work = {kRows, kPadded},
                         .x = x,
                         .skip = skip,
                         .mean = mean_,
                         .variance = variance_,
                         .weight = In(weight_),
                         .bias = In(bias_),
                         .activation = activation,
                         .y = y});
  }

  void Backward(const Source& x, const Source& y, const Source& dy, Activation activation,
                const Target& dx, const Target& dskip) {
    Run(BatchNormWeights{.sums = NewSums(2),
                         .x = x,
                         .dy = dy,
                         .y = y,
                         .mean = mean_,
                         .variance = variance_,
                         .activation = activation,
                         .dweight = dweight_,
                         .dbias = dbias_});
    Run(BatchNormBackward{.work = {kRows, kPadded},
                          .x = x,
                          .dy = dy,
                          .y = y,
                          .inverse = float(1.0 / kRows),
                          .mean = mean_,
                          .variance = variance_,
                          .weight = In(weight_),
                          .dweight = dweight_,
                          .dbias = dbias_,
                          .activation = activation,
                          .dx = dx,
                          .dskip = dskip});
  }

  struct Statistics {
    double mean, variance;
  };
  static Statistics Of(const Doubles& column) {
    double mean = 0, squares = 0;
    for (const double value : column) mean += value / kRows;
    for (const double value : column) squares += (value - mean) * (value - mean) / kRows;
    return {mean, squares};
  }
  static Doubles Column(const std::vector<float>& values, size_t c) {
    Doubles column;
    for (size_t row = 0; row < kRows; ++row) column.push_back(double(values[row * kPadded + c]));
    return column;
  }
  // sum dy y of one channel, in double.
  double Loss(const Doubles& x, const Doubles& skip, size_t c, double weight, double bias,
              bool relu) const {
    const auto [mean, variance] = Of(x);
    double loss = 0;
    for (size_t row = 0; row < kRows; ++row) {
      const double sum = weight * (x[row] - mean) / std::sqrt(variance + 1e-5) + bias + skip[row];
      loss += double(dy_[row * kPadded + c]) * (relu ? std::max(sum, 0.0) : sum);
    }
    return loss;
  }
  void CompareGradients(Activation activation);

  // Means are far from 0, as the square of the mean and the mean of squares would need more digits
  // than f32 has.
  std::vector<float> x_ = Random(kNumbers, 29, 31), dy_ = Random(kNumbers),
                     skip_ = Random(kNumbers);
  std::vector<float> weight_ = Random(kPadded, 0.5, 2), bias_ = Random(kPadded);
  std::vector<float> running_mean_ = Random(kPadded), running_variance_ = Random(kPadded, 0.5, 2);
  float *mean_ = Out(kPadded), *variance_ = Out(kPadded);
  float *next_mean_ = Out(kPadded), *next_variance_ = Out(kPadded);
  float *dweight_ = Out(kPadded), *dbias_ = Out(kPadded);
};

TEST_F(BatchNormKernels, StatisticsOfTheBatchMoveTheRunningOnes) {
  Measure({In(x_), nullptr});
  for (size_t c = 0; c < kPadded; ++c) {
    const auto [mean, variance] = Of(Column(x_, c));
    ASSERT_NEAR(mean_[c], mean, 1e-5) << c;
    ASSERT_NEAR(variance_[c], variance, 1e-5) << c;
    ASSERT_NEAR(next_mean_[c], 0.9 * double(running_mean_[c]) + 0.1 * mean, 1e-5) << c;
    ASSERT_NEAR(next_variance_[c],
                0.9 * double(running_variance_[c]) + 0.1 * variance * kRows / (kRows - 1), 1e-5)
        << c;
    if (c >= kChannels) {
      ASSERT_EQ(next_variance_[c], 0) << c;
    }
  }
}

TEST_F(BatchNormKernels, MapsAreNormalisedThenAddedThenCut) {
  const Source x{In(x_), nullptr}, skip{In(skip_), nullptr};
  Measure(x);
  for (const bool skips : {false, true}) {
    for (const Activation activation : {Activation::kNone, Activation::kRelu}) {
      float* y = Out(kNumbers);
      Forward(x, skips ? skip : Source{}, activation, {y, nullptr});
      for (size_t c = 0; c < kPadded; ++c) {
        const auto [mean, variance] = Of(Column(x_, c));
        for (size_t i = c; i < kNumbers; i += kPadded) {
          const double normal = (double(x_[i]) - mean) / std::sqrt(variance + 1e-5);
          const double sum =
              double(weight_[c]) * normal + double(bias_[c]) + (skips ? double(skip_[i]) : 0);
          ASSERT_NEAR(y[i], activation == Activation::kRelu ? std::max(sum, 0.0) : sum, 1e-4) << i;
        }
      }
    }
  }
}

void BatchNormKernels::CompareGradients(Activation activation) {
  const bool relu = activation == Activation::kRelu;
  const Source x{In(x_), nullptr};
  float *y = Out(kNumbers), *dx = In(dy_), *dskip = Out(kNumbers), *apart = Out(kNumbers);
  Measure(x);
  Forward(x, {In(skip_), nullptr}, activation, {y, nullptr});
  Backward(x, {y, nullptr}, {In(dy_), nullptr}, activation, {apart, nullptr}, {});
  // The gradient of x replaces that of y.
  Run(BatchNormBackward{.work = {kRows, kPadded},
                        .x = x,
                        .dy = {dx, nullptr},
                        .y = {y, nullptr},
                        .inverse = float(1.0 / kRows),
                        .mean = mean_,
                        .variance = variance_,
                        .weight = In(weight_),
                        .dweight = dweight_,
                        .dbias = dbias_,
                        .activation = activation,
                        .dx = {dx, nullptr},
                        .dskip = {dskip, nullptr}});
  constexpr double kStep = 1e-6;
  for (size_t c = 0; c < kPadded; ++c) {
    const Doubles of_x = Column(x_, c), of_skip = Column(skip_, c);
    const auto slope = [&](const auto& loss) { return (loss(kStep) - loss(-kStep)) / (2 * kStep); };
    const double weight = double(weight_[c]), bias = double(bias_[c]);
    ASSERT_NEAR(dweight_[c],
                slope([&](double d) { return Loss(of_x, of_skip, c, weight + d, bias, relu); }),
                1e-3);
    ASSERT_NEAR(dbias_[c],
                slope([&](double d) { return Loss(of_x, of_skip, c, weight, bias + d, relu); }),
                1e-4);
    for (size_t row = 0; row < kRows; ++row) {
      const auto moved = [&](Doubles column, double d) {
        column[row] += d;
        return column;
      };
      const size_t at = row * kPadded + c;
      ASSERT_NEAR(dx[at], slope([&](double d) {
                    return Loss(moved(of_x, d), of_skip, c, weight, bias, relu);
                  }),
                  2e-4)
          << at;
      ASSERT_EQ(apart[at], dx[at]) << at;
      ASSERT_NEAR(dskip[at], slope([&](double d) {
                    return Loss(of_x, moved(of_skip, d), c, weight, bias, relu);
                  }),
                  1e-6)
          << at;
    }
  }
}

TEST_F(BatchNormKernels, GradientsBeforeARelu) { CompareGradients(Activation::kRelu); }

TEST_F(BatchNormKernels, GradientsWithoutAnActivation) { CompareGradients(Activation::kNone); }

TEST_F(BatchNormKernels, Bf16IsReadAndWritten) {
  const auto narrow = [&](const std::vector<float>& values) {
    std::vector<uint16_t> rounded;
    rounded.reserve(values.size());
    for (const float value : values) rounded.push_back(ToBf16(value));
    return In(rounded);
  };
  const auto wide = [&](const uint16_t* values) { return In(FromBf16s(values, kNumbers)); };
  const uint16_t *x = narrow(x_), *skip = narrow(skip_), *dy = narrow(dy_);
  Measure({nullptr, x});
  auto *y = Out<uint16_t>(kNumbers), *dx = Out<uint16_t>(kNumbers), *ds = Out<uint16_t>(kNumbers);
  Forward({nullptr, x}, {nullptr, skip}, Activation::kRelu, {nullptr, y});
  Backward({nullptr, x}, {nullptr, y}, {nullptr, dy}, Activation::kRelu, {nullptr, dx},
           {nullptr, ds});
  float *wide_y = Out(kNumbers), *wide_dx = Out(kNumbers), *wide_ds = Out(kNumbers);
  Measure({wide(x), nullptr});
  Forward({wide(x), nullptr}, {wide(skip), nullptr}, Activation::kRelu, {wide_y, nullptr});
  Backward({wide(x), nullptr}, {wide(y), nullptr}, {wide(dy), nullptr}, Activation::kRelu,
           {wide_dx, nullptr}, {wide_ds, nullptr});
  for (size_t i = 0; i < kNumbers; ++i) {
    ASSERT_EQ(y[i], ToBf16(wide_y[i])) << i;
    ASSERT_EQ(dx[i], ToBf16(wide_dx[i])) << i;
    ASSERT_EQ(ds[i], ToBf16(wide_ds[i])) << i;
  }
}

TEST_F(BatchNormKernels, MapsAreAdded) {
  float* sum = In(x_);
  Run(AddMap{.n = kNumbers,
             .addend = {In(dy_), nullptr},
             .before = {sum, nullptr},
             .sum = {sum, nullptr}});
  for (size_t i = 0; i < kNumbers; ++i) ASSERT_EQ(sum[i], x_[i] + dy_[i]) << i;
}

}  // namespace
}  // namespace shoal::learner::kernels
