// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "common/base/random.h"
#include "learner/device/commands.h"
#include "learner/device/host_device.h"
#include "tests/cuda/trial.h"

namespace shoal::trial {
namespace {

using namespace learner::device;  // NOLINT: this file is about its commands

constexpr double kF32Limit = 1e-5, kBf16Limit = 2e-2;

int64_t SizeOf(Type type) { return type == Type::kBf16 ? 2 : 4; }

uint16_t Rounded(float value) { return uint16_t((std::bit_cast<uint32_t>(value) + 0x8000u) >> 16); }
float Widened(uint16_t bits) { return std::bit_cast<float>(uint32_t{bits} << 16); }

// Numbers of one type in host memory.
struct Numbers {
  Numbers(Type t, int64_t count) : type(t), bytes(size_t(count * SizeOf(t))) {}

  int64_t count() const { return int64_t(bytes.size()) / SizeOf(type); }
  float Get(int64_t i) const {
    if (type == Type::kF32) {
      float value;
      std::memcpy(&value, &bytes[size_t(i) * 4], 4);
      return value;
    }
    uint16_t bits;
    std::memcpy(&bits, &bytes[size_t(i) * 2], 2);
    return Widened(bits);
  }
  void Set(int64_t i, float value) {
    const uint16_t bits = Rounded(value);
    if (type == Type::kF32) {
      std::memcpy(&bytes[size_t(i) * 4], &value, 4);
    } else {
      std::memcpy(&bytes[size_t(i) * 2], &bits, 2);
    }
  }

  Type type;
  std::vector<std::byte> bytes;
};

Numbers Noise(Type type, int64_t count, uint64_t seed) {
  Numbers numbers(type, count);
  Random random(seed);
  for (int64_t i = 0; i < count; ++i) numbers.Set(i, float(random.Uniform(-1, 1)));
  return numbers;
}

// Memory of a device with the contents of `numbers`.
class OnDevice {
 public:
  OnDevice(Device* device, const Numbers& numbers)
      : device_(device), memory_(device->Allocate(int64_t(numbers.bytes.size()))) {
    device->CopyIn(Lane::kCommands, numbers.bytes.data(), int64_t(numbers.bytes.size()), memory_);
    device->Finish();
  }
  ~OnDevice() { device_->Free(memory_); }
  OnDevice(const OnDevice&) = delete;
  OnDevice& operator=(const OnDevice&) = delete;

  void* get() const { return memory_; }
  Numbers Read(Type type, int64_t count) const {
    Numbers numbers(type, count);
    device_->Finish();
    device_->CopyOut(Lane::kCommands, memory_, int64_t(numbers.bytes.size()), numbers.bytes.data());
    device_->Finish();
    return numbers;
  }

 private:
  Device* const device_;
  void* const memory_;
};

// A command with the memory of its operands, on one device: inputs and poisoned results.
struct Operands {
  std::vector<Numbers> inputs;
  std::vector<std::pair<Type, int64_t>> results;
};
using MakeCommand =
    std::function<Command(const std::vector<void*>& inputs, const std::vector<void*>& results)>;

// Results of the command, run once directly and once as a recording.
std::vector<Numbers> ResultsOn(Device* device, const Operands& operands, const MakeCommand& make,
                               bool recorded) {
  std::vector<std::unique_ptr<OnDevice>> memory;
  std::vector<void*> inputs, results;
  for (const Numbers& input : operands.inputs) {
    inputs.push_back(memory.emplace_back(std::make_unique<OnDevice>(device, input))->get());
  }
  for (const auto& [type, count] : operands.results) {
    Numbers poison(type, count);
    for (int64_t i = 0; i < count; ++i) poison.Set(i, std::numeric_limits<float>::quiet_NaN());
    results.push_back(memory.emplace_back(std::make_unique<OnDevice>(device, poison))->get());
  }
  CommandList list;
  list.Add(make(inputs, results));
  if (recorded) {
    const auto recording = device->Record(list);
    device->Replay(*recording);
    device->Finish();
  } else {
    device->Run(list);
  }
  std::vector<Numbers> read;
  for (size_t i = 0; i < results.size(); ++i) {
    read.push_back(memory[operands.inputs.size() + i]->Read(operands.results[i].first,
                                                            operands.results[i].second));
  }
  return read;
}

// The largest difference, divided by the largest number; infinite if a number is not finite.
double Difference(const std::vector<Numbers>& a, const std::vector<Numbers>& b) {
  double worst = 0;
  for (size_t r = 0; r < a.size(); ++r) {
    double difference = 0, largest = 0;
    for (int64_t i = 0; i < a[r].count(); ++i) {
      const double x = a[r].Get(i), y = b[r].Get(i);
      if (std::isnan(x) && std::isnan(y)) continue;  // outside of the rows that a command writes
      if (!std::isfinite(x) || !std::isfinite(y)) return std::numeric_limits<double>::infinity();
      difference = std::max(difference, std::abs(x - y));
      largest = std::max(largest, std::abs(y));
    }
    worst = std::max(worst, difference / std::max(largest, 1e-30));
  }
  return worst;
}

void Try(Device* device, const std::string& name, Type type, const Operands& operands,
         const MakeCommand& make, const Trials& trials) {
  trials.TryError(name, "relative error", type == Type::kF32 ? kF32Limit : kBf16Limit, [&] {
    HostDevice host;
    const auto expected = ResultsOn(&host, operands, make, /*recorded=*/false);
    const double direct = Difference(ResultsOn(device, operands, make, false), expected);
    return std::max(direct, Difference(ResultsOn(device, operands, make, true), expected));
  });
}

std::string TypeName(Type type) { return type == Type::kF32 ? "f32" : "bf16"; }

// Rows of the matrices are `gap` numbers longer than they need.
void TryProduct(Device* device, Product shape, int32_t gap, const Trials& trials) {
  const int32_t a_columns = shape.a_transposed ? shape.rows : shape.depth;
  const int32_t b_columns = shape.b_transposed ? shape.depth : shape.columns;
  const int32_t a_rows = shape.a_transposed ? shape.depth : shape.rows;
  const int32_t b_rows = shape.b_transposed ? shape.columns : shape.depth;
  shape.a_stride = a_columns + gap;
  shape.b_stride = b_columns + gap;
  shape.d_stride = shape.columns + gap;
  shape.a_step = int64_t(a_rows) * shape.a_stride;
  shape.b_step = int64_t(b_rows) * shape.b_stride;
  shape.d_step = int64_t(shape.rows) * shape.d_stride;
  shape.bias_step = shape.columns;
  const Operands operands{.inputs = {Noise(shape.input, shape.count * shape.a_step, 1),
                                     Noise(shape.input, shape.count * shape.b_step, 2),
                                     Noise(Type::kF32, shape.count * shape.bias_step, 3)},
                          .results = {{shape.output, shape.count * shape.d_step}}};
  const bool bias = shape.relu;  // both or none
  Try(
      device,
      fmt::format("product {}{} ({}, {}){} x ({}, {}){}{}{}", TypeName(shape.input),
                  shape.output == Type::kBf16 ? " to bf16" : "", shape.rows, shape.depth,
                  shape.a_transposed ? "T" : "", shape.depth, shape.columns,
                  shape.b_transposed ? "T" : "", bias ? ", bias, ReLU" : "",
                  shape.count > 1 ? fmt::format(", {} times", shape.count) : ""),
      shape.input, operands,
      [=](const auto& inputs, const auto& results) {
        Product product = shape;
        product.a = inputs[0];
        product.b = inputs[1];
        product.bias = bias ? static_cast<const float*>(inputs[2]) : nullptr;
        product.d = results[0];
        return product;
      },
      trials);
}

void TryProducts(Device* device, bool quick, const Trials& trials) {
  const std::vector<std::array<int32_t, 3>> shapes =
      quick ? std::vector<std::array<int32_t, 3>>{{6, 10, 14}}
            : std::vector<std::array<int32_t, 3>>{
                  {128, 50, 2048}, {128, 256, 54}, {256, 1024, 50}, {256, 1, 256}, {7, 11, 13}};
  for (const auto& [rows, columns, depth] : shapes) {
    for (const Type input : {Type::kF32, Type::kBf16}) {
      for (const int transposed : {0, 1, 2}) {
        TryProduct(device,
                   {.rows = rows,
                    .columns = columns,
                    .depth = depth,
                    .input = input,
                    .a_transposed = transposed == 1,
                    .b_transposed = transposed == 2},
                   0, trials);
      }
      TryProduct(device,
                 {.rows = rows,
                  .columns = columns,
                  .depth = depth,
                  .input = input,
                  .output = input,
                  .relu = true,
                  .count = 2},
                 8, trials);
    }
  }
}

ConvolutionShape Shape(Type type, int32_t batch, int32_t size, int32_t channels, int32_t filters,
                       int32_t kernel, int32_t stride, int32_t padding) {
  const int32_t output = (size + 2 * padding - kernel) / stride + 1;
  return {.type = type,
          .batch = batch,
          .height = size,
          .width = size,
          .channels = channels,
          .filters = filters,
          .kernel = kernel,
          .stride = stride,
          .padding = padding,
          .output_height = output,
          .output_width = output};
}

void TryConvolution(Device* device, const ConvolutionShape& s, const Trials& trials) {
  const int64_t inputs = int64_t(s.batch) * s.height * s.width * s.channels;
  const int64_t outputs = int64_t(s.batch) * s.output_height * s.output_width * s.filters;
  const int64_t weights = int64_t(s.filters) * s.kernel * s.kernel * s.channels;
  const std::string name =
      fmt::format("{} ({}, {}, {}, {}), {} of {} x {}, stride {}", TypeName(s.type), s.batch,
                  s.height, s.width, s.channels, s.filters, s.kernel, s.kernel, s.stride);
  const Numbers x = Noise(s.type, inputs, 1), weight = Noise(s.type, weights, 2),
                dy = Noise(s.type, outputs, 3), bias = Noise(Type::kF32, s.filters, 4);
  Try(
      device, "convolution " + name, s.type,
      {.inputs = {x, weight, bias}, .results = {{s.type, outputs}}},
      [&](const auto& in, const auto& out) {
        return ConvolutionForward{.shape = s,
                                  .x = in[0],
                                  .weight = in[1],
                                  .bias = static_cast<const float*>(in[2]),
                                  .relu = true,
                                  .y = out[0]};
      },
      trials);
  Try(
      device, "gradient by input " + name, s.type,
      {.inputs = {dy, weight}, .results = {{s.type, inputs}}},
      [&](const auto& in, const auto& out) {
        return ConvolutionData{.shape = s, .dy = in[0], .weight = in[1], .dx = out[0]};
      },
      trials);
  Try(
      device, "gradient by weights and bias " + name, s.type,
      {.inputs = {x, dy}, .results = {{Type::kF32, weights}, {Type::kF32, s.filters}}},
      [&](const auto& in, const auto& out) {
        return ConvolutionWeights{.shape = s,
                                  .x = in[0],
                                  .dy = in[1],
                                  .weight_gradient = static_cast<float*>(out[0]),
                                  .bias_gradient = static_cast<float*>(out[1])};
      },
      trials);
}

}  // namespace

void TryCommands(Device* device, bool quick, const Trials& trials) {
  TryProducts(device, quick, trials);
  for (const Type type : {Type::kF32, Type::kBf16}) {
    TryConvolution(device, Shape(type, 3, 9, 8, 16, 3, 2, 0), trials);
    TryConvolution(device, Shape(type, 2, 8, 8, 8, 3, 1, 1), trials);
    if (quick) continue;
    TryConvolution(device, Shape(type, 16, 42, 8, 32, 3, 2, 0), trials);  // compact
    TryConvolution(device, Shape(type, 8, 41, 32, 32, 3, 1, 0), trials);  // drq
    TryConvolution(device, Shape(type, 8, 84, 8, 32, 8, 4, 0), trials);   // nature
    // Larger than our kernels compute in bf16.
    TryConvolution(device, Shape(type, 4, 10, 64, 192, 3, 1, 1), trials);
  }
}

}  // namespace shoal::trial
