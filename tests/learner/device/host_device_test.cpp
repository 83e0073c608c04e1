// SPDX-License-Identifier: Apache-2.0
// Checks the device of tests itself: order of work, guards, and products and convolutions against
// formulas in double.
#include "learner/device/host_device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "common/base/random.h"

namespace shoal::learner::device {
namespace {

class HostDeviceTest : public testing::Test {
 protected:
  ~HostDeviceTest() override {
    for (void* memory : allocated_) device_.Free(memory);
  }

  std::vector<float> Numbers(size_t n) {
    std::vector<float> values(n);
    for (float& value : values) value = float(random_.Uniform(-1, 1));
    return values;
  }
  template <class T = float>
  T* New(size_t n) {
    allocated_.push_back(device_.Allocate(int64_t(n * sizeof(T))));
    return static_cast<T*>(allocated_.back());
  }
  // Values of a type, in memory of the device. In bf16, *values become the rounded ones.
  void* In(Type type, std::vector<float>* values) {
    float* f32 = New(values->size());
    auto* bf16 = New<uint16_t>(values->size());
    for (size_t i = 0; i < values->size(); ++i) {
      bf16[i] = kernels::ToBf16((*values)[i]);
      if (type == Type::kBf16) (*values)[i] = kernels::FromBf16(bf16[i]);
      f32[i] = (*values)[i];
    }
    return type == Type::kBf16 ? static_cast<void*>(bf16) : f32;
  }
  static float At(Type type, const void* values, size_t i) {
    return type == Type::kF32 ? static_cast<const float*>(values)[i]
                              : kernels::FromBf16(static_cast<const uint16_t*>(values)[i]);
  }
  void Run(const Command& command) {
    CommandList list;
    list.Add(command);
    device_.Run(list);
    device_.Finish();
  }

  void CompareProduct(Type input, Type output, bool a_transposed, bool b_transposed);
  void CompareConvolution(Type type, ConvolutionShape shape);

  Random random_{uint64_t(testing::UnitTest::GetInstance()->random_seed()) + 7};
  HostDevice device_;
  std::vector<void*> allocated_;
};

TEST_F(HostDeviceTest, WorkRunsWhenTheHostWaits) {
  float *memory = New(2), host[2] = {1, 2}, back[2] = {0, 0};
  EXPECT_TRUE(std::isnan(memory[0])) << "fresh memory is invalid";
  device_.CopyIn(Lane::kCopies, host, sizeof(host), memory);
  host[0] = 3;  // too early: the copy has not been made
  const auto copied = device_.NewEvent(), read = device_.NewEvent();
  device_.Mark(Lane::kCopies, copied.get());
  device_.Await(Lane::kCommands, *copied);
  device_.CopyOut(Lane::kCommands, memory, sizeof(back), back);
  device_.Mark(Lane::kCommands, read.get());
  EXPECT_EQ(back[1], 0);
  device_.Wait(*read);
  EXPECT_EQ(back[0], 3);
  EXPECT_EQ(back[1], 2);
}

TEST_F(HostDeviceTest, LanesWithoutEventsRunInAnyOrder) {
  for (const Lane first : {Lane::kCommands, Lane::kCopies}) {
    HostDevice device({.first = first});
    auto* memory = static_cast<float*>(device.Allocate(sizeof(float)));
    const float host = 4;
    float back = 0;
    device.CopyIn(Lane::kCopies, &host, sizeof(host), memory);
    device.CopyOut(Lane::kCommands, memory, sizeof(back), &back);
    device.Finish();
    EXPECT_EQ(std::isnan(back), first == Lane::kCommands);
    device.Free(memory);
  }
}

TEST_F(HostDeviceTest, ARecordingRunsItsCommandsAgain) {
  float *memory = New(1), *squares = New(1);
  CommandList list;
  list.Add(Clear{memory, sizeof(float)});
  list.Add(Copy{memory, squares, sizeof(float)});
  const auto recording = device_.Record(list);
  list.Reset();
  device_.Finish();
  EXPECT_TRUE(std::isnan(*squares)) << "recording runs nothing";
  device_.Replay(*recording);
  device_.Finish();
  EXPECT_EQ(*squares, 0);
  *memory = *squares = 1;
  device_.Replay(*recording);
  device_.Finish();
  EXPECT_EQ(*squares, 0);
}

using HostDeviceDeathTest = HostDeviceTest;

TEST_F(HostDeviceDeathTest, AWriteBesideAnAllocationIsFound) {
  auto* memory = New<char>(3);
#if defined(__SANITIZE_ADDRESS__)
  EXPECT_DEATH(memory[3] = 0, "AddressSanitizer");
#else
  EXPECT_DEATH((memory[3] = 0, device_.Finish()), "a write behind an allocation of 3 bytes");
  EXPECT_DEATH((memory[-1] = 0, device_.Finish()), "a write before an allocation of 3 bytes");
#endif
}

TEST_F(HostDeviceDeathTest, ACopyBeyondAnAllocationIsRefused) {
  const auto* memory = New<char>(3);
  char host[4];
  EXPECT_DEATH(device_.CopyOut(Lane::kCopies, memory, 4, host), "4 bytes from byte 0 of 3");
  EXPECT_DEATH(device_.CopyIn(Lane::kCopies, host, 3, host), "no memory|3 bytes from byte");
}

TEST_F(HostDeviceDeathTest, MemoryThatWasNotFreedIsFound) {
  EXPECT_DEATH(
      {
        HostDevice device;
        device.Allocate(1);
      },
      "1 allocations were not freed");
}

// Two products with strides, a bias and, in f32, a ReLU.
void HostDeviceTest::CompareProduct(Type input, Type output, bool a_transposed, bool b_transposed) {
  constexpr int kRows = 5, kColumns = 7, kDepth = 11, kStride = 13;
  constexpr size_t kStep = 11 * kStride + 2;
  std::vector<float> a = Numbers(2 * kStep), b = Numbers(2 * kStep), bias = Numbers(2 * kColumns);
  Product product{
      .rows = kRows,
      .columns = kColumns,
      .depth = kDepth,
      .input = input,
      .output = output,
      .a = In(input, &a),
      .b = In(input, &b),
      .d = output == Type::kF32 ? static_cast<void*>(New(2 * kStep)) : New<uint16_t>(2 * kStep),
      .a_stride = kStride,
      .b_stride = kStride,
      .d_stride = kStride,
      .a_transposed = a_transposed,
      .b_transposed = b_transposed,
      .bias = static_cast<const float*>(In(Type::kF32, &bias)),
      .relu = output == Type::kF32,
      .count = 2,
      .a_step = kStep,
      .b_step = kStep,
      .d_step = kStep,
      .bias_step = kColumns};
  Run(product);
  for (size_t p = 0; p < 2; ++p) {
    for (size_t i = 0; i < kRows; ++i) {
      for (size_t j = 0; j < kColumns; ++j) {
        double sum = bias[p * kColumns + j];
        for (size_t k = 0; k < kDepth; ++k) {
          sum += double(a[p * kStep + (a_transposed ? k * kStride + i : i * kStride + k)]) *
                 b[p * kStep + (b_transposed ? j * kStride + k : k * kStride + j)];
        }
        if (product.relu) sum = std::max(sum, 0.0);
        EXPECT_NEAR(At(output, product.d, p * kStep + i * kStride + j), sum,
                    output == Type::kF32 ? 1e-5 : 0.004 * std::abs(sum) + 1e-6);
      }
    }
    EXPECT_TRUE(std::isnan(At(output, product.d, p * kStep + kColumns))) << "between two rows";
  }
}

TEST_F(HostDeviceTest, Products) {
  CompareProduct(Type::kF32, Type::kF32, false, false);
  CompareProduct(Type::kF32, Type::kF32, true, false);
  CompareProduct(Type::kF32, Type::kF32, false, true);
  CompareProduct(Type::kBf16, Type::kF32, true, true);
  CompareProduct(Type::kBf16, Type::kBf16, false, true);
}

double Dot(const std::vector<float>& a, const std::vector<double>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// y without bias and ReLU, in double.
std::vector<double> Convolve(const ConvolutionShape& s, const std::vector<float>& x,
                             const std::vector<float>& weight) {
  std::vector<double> y;
  for (int b = 0; b < s.batch; ++b) {
    for (int at = 0; at < s.output_height * s.output_width * s.filters; ++at) {
      const int n = at % s.filters, j = at / s.filters % s.output_width;
      const int i = at / s.filters / s.output_width;
      double sum = 0;
      for (int k = 0; k < s.kernel * s.kernel * s.channels; ++k) {
        const int c = k % s.channels, v = k / s.channels % s.kernel, u = k / s.channels / s.kernel;
        const int row = i * s.stride + u - s.padding, column = j * s.stride + v - s.padding;
        if (row < 0 || row >= s.height || column < 0 || column >= s.width) continue;
        const int from = ((b * s.height + row) * s.width + column) * s.channels + c;
        const int by = n * s.kernel * s.kernel * s.channels + k;
        sum += double(x[size_t(from)]) * weight[size_t(by)];
      }
      y.push_back(sum);
    }
  }
  return y;
}

// The gradients are checked by the convolution's linearity: for random x2 and w2,
//   <dx, x2> = <dy, conv(x2, w)>,   <dw, w2> = <dy, conv(x, w2)>
void HostDeviceTest::CompareConvolution(Type type, ConvolutionShape shape) {
  shape.type = type;
  shape.output_height = (shape.height + 2 * shape.padding - shape.kernel) / shape.stride + 1;
  shape.output_width = (shape.width + 2 * shape.padding - shape.kernel) / shape.stride + 1;
  const size_t batch = size_t(shape.batch), filters = size_t(shape.filters);
  const size_t channels = size_t(shape.channels), kernel = size_t(shape.kernel);
  const size_t inputs = batch * size_t(shape.height) * size_t(shape.width) * channels;
  const size_t weights = filters * kernel * kernel * channels;
  const size_t outputs = batch * size_t(shape.output_height) * size_t(shape.output_width) * filters;
  const double tolerance = type == Type::kF32 ? 1e-5 : 0.02;
  std::vector<float> x = Numbers(inputs), weight = Numbers(weights), dy = Numbers(outputs);
  std::vector<float> bias = Numbers(size_t(shape.filters));
  const void *of_x = In(type, &x), *of_weight = In(type, &weight), *of_dy = In(type, &dy);
  const auto* of_bias = static_cast<const float*>(In(Type::kF32, &bias));
  const auto result = [&](size_t n) {
    return type == Type::kF32 ? static_cast<void*>(New(n)) : New<uint16_t>(n);
  };
  void *y = result(outputs), *dx = result(inputs);
  Run(ConvolutionForward{shape, of_x, of_weight, of_bias, /*relu=*/true, y});
  const std::vector<double> expected = Convolve(shape, x, weight);
  for (size_t i = 0; i < outputs; ++i) {
    const double value = std::max(0.0, expected[i] + bias[i % size_t(shape.filters)]);
    ASSERT_NEAR(At(type, y, i), value, tolerance * (1 + value)) << i;
  }

  Run(ConvolutionData{shape, of_dy, of_weight, dx});
  float *dweight = New(weights), *dbias = New(size_t(shape.filters));
  Run(ConvolutionWeights{shape, of_x, of_dy, dweight, dbias});
  const std::vector<float> x2 = Numbers(inputs), weight2 = Numbers(weights);
  double to_x = 0, to_weight = 0;
  for (size_t i = 0; i < inputs; ++i) to_x += double(At(type, dx, i)) * x2[i];
  for (size_t i = 0; i < weights; ++i) to_weight += double(dweight[i]) * weight2[i];
  EXPECT_NEAR(to_x, Dot(dy, Convolve(shape, x2, weight)), 10 * tolerance);
  EXPECT_NEAR(to_weight, Dot(dy, Convolve(shape, x, weight2)), 10 * tolerance);
  std::vector<double> sums(size_t(shape.filters), 0.0);
  for (size_t i = 0; i < outputs; ++i) sums[i % sums.size()] += At(type, of_dy, i);
  for (size_t n = 0; n < sums.size(); ++n) EXPECT_NEAR(dbias[n], sums[n], 1e-5) << n;
}

TEST_F(HostDeviceTest, Convolutions) {
  const ConvolutionShape strided{
      .batch = 2, .height = 9, .width = 7, .channels = 3, .filters = 5, .kernel = 3, .stride = 2};
  const ConvolutionShape padded{
      .batch = 2, .height = 5, .width = 6, .channels = 2, .filters = 3, .kernel = 3, .padding = 1};
  for (const Type type : {Type::kF32, Type::kBf16}) {
    CompareConvolution(type, strided);
    CompareConvolution(type, padded);
  }
}

}  // namespace
}  // namespace shoal::learner::device
