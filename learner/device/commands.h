// SPDX-License-Identifier: Apache-2.0
// Commands of a device (device.h), and lists of commands.
//
// The engine builds one list for each update. A command is a value: addresses, sizes and constants.
// If the list of an update equals the list of an earlier update, the engine replays the earlier
// list's recording. A number that changes from update to update must therefore be in the device's
// memory, and never in a command.
//
// A command reads results of earlier commands of its list. Results are overwritten; they overlap no
// input. Every sum has a fixed order, so equal inputs give equal bits.
//
// bf16 numbers are the upper 16 bits of an f32 (uint16_t). Products and convolutions compute bf16
// inputs with sums in f32, and f32 inputs in f32 (without TF32). Results in bf16 are rounded to
// nearest, ties to even.
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "learner/device/kernels/kernels.h"

namespace shoal::learner::device {

enum class Type : int32_t { kF32, kBf16 };

// Sets `bytes` bytes to 0.
struct Clear {
  void* memory = nullptr;
  int64_t bytes = 0;

  bool operator==(const Clear&) const = default;
};

// Copies within the device's memory.
struct Copy {
  const void* from = nullptr;
  void* to = nullptr;
  int64_t bytes = 0;

  bool operator==(const Copy&) const = default;
};

// D = op(A) op(B) + bias: product of row-major matrices.
//
//   D (rows, columns), op(A) (rows, depth), op(B) (depth, columns)
//
// op(A) is A (rows, depth), or the transpose of A (depth, rows) if a_transposed; B likewise. The
// row of a matrix in memory begins `..._stride` numbers after the row before it.
//
// `count` products of one shape are computed together. Matrices of product i begin i times
// `..._step` numbers after those of product 0.
struct Product {
  int32_t rows = 0, columns = 0, depth = 0;
  Type input = Type::kF32;   // of A and B
  Type output = Type::kF32;  // of D
  const void* a = nullptr;
  const void* b = nullptr;
  void* d = nullptr;
  int32_t a_stride = 0, b_stride = 0, d_stride = 0;
  bool a_transposed = false, b_transposed = false;
  const float* bias = nullptr;  // (columns), or null
  bool relu = false;            // D = max(0, D) at last
  int32_t count = 1;
  int64_t a_step = 0, b_step = 0, d_step = 0, bias_step = 0;

  bool operator==(const Product&) const = default;
};

// Shapes of a convolution. Maps are (batch, height, width, channels), weights (filters, kernel,
// kernel, channels), the output (batch, output_height, output_width, filters): channels are
// adjacent in memory.
//
//   y[b, i, j, n] = bias[n] + sum_{u,v,c} weight[n, u, v, c] x[b, i s + u - p, j s + v - p, c]
//
// Outside of its map, x is 0. `type` is the type of maps, of their gradients and of weights.
struct ConvolutionShape {
  Type type = Type::kF32;
  int32_t batch = 0, height = 0, width = 0, channels = 0;
  int32_t filters = 0, kernel = 1, stride = 1, padding = 0;
  int32_t output_height = 0, output_width = 0;

  bool operator==(const ConvolutionShape&) const = default;
};

struct ConvolutionForward {
  ConvolutionShape shape;
  const void* x = nullptr;
  const void* weight = nullptr;
  const float* bias = nullptr;  // (filters), or null
  bool relu = false;            // y = max(0, y) at last
  void* y = nullptr;

  bool operator==(const ConvolutionForward&) const = default;
};

// dL/dx from dL/dy.
struct ConvolutionData {
  ConvolutionShape shape;
  const void* dy = nullptr;
  const void* weight = nullptr;
  void* dx = nullptr;

  bool operator==(const ConvolutionData&) const = default;
};

// dL/dweight and dL/dbias, f32, from x and dL/dy.
struct ConvolutionWeights {
  ConvolutionShape shape;
  const void* x = nullptr;
  const void* dy = nullptr;
  float* weight_gradient = nullptr;
  float* bias_gradient = nullptr;  // (filters), or null

  bool operator==(const ConvolutionWeights&) const = default;
};

using Command = std::variant<kernels::Kernel, Clear, Copy, Product, ConvolutionForward,
                             ConvolutionData, ConvolutionWeights>;

class CommandList {
 public:
  void Add(const Command& command) { commands_.push_back(command); }
  void Replace(size_t at, const Command& command) { commands_[at] = command; }
  void Reset() { commands_.clear(); }

  const std::vector<Command>& commands() const { return commands_; }
  bool empty() const { return commands_.empty(); }
  bool operator==(const CommandList&) const = default;

 private:
  std::vector<Command> commands_;
};

}  // namespace shoal::learner::device
