// SPDX-License-Identifier: Apache-2.0
// An ONNX file as a value: the subset of the format that a policy needs, and its encoding.
//
// Constants are f32. The first dimension of the inputs and of the output is the batch size N, which
// the program that runs the file chooses. A node comes after the nodes whose outputs it reads.
//
// Source: ONNX, github.com/onnx/onnx, docs/IR.md and docs/Operators.md, operator set 17 of 2022.
// This is the first set with LayerNormalization; later runtimes still read this set.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace shoal::launch {

inline constexpr int kOnnxOperatorSet = 17;
inline constexpr int kOnnxIrVersion = 8;  // IR version of that operator set

// Array of numbers, row-major. If `shape` is empty, the tensor is a single number.
struct OnnxTensor {
  std::vector<int64_t> shape = {};
  std::vector<float> values = {};

  bool operator==(const OnnxTensor&) const = default;
};

// Number of elements of a tensor with this shape.
size_t Count(const std::vector<int64_t>& shape);

using OnnxAttribute = std::variant<int64_t, float, std::vector<int64_t>>;

struct OnnxNode {
  std::string op;                   // "Conv"
  std::vector<std::string> inputs;  // names of constants, model inputs or earlier outputs
  std::string output;
  std::map<std::string, OnnxAttribute> attributes = {};

  bool operator==(const OnnxNode&) const = default;
};

// An input or an output: (N, shape...).
struct OnnxPort {
  enum class Type { kF32 = 1, kU8 = 2 };  // the format's numbers
  std::string name = {};
  Type type = Type::kF32;
  std::vector<int64_t> shape = {};

  bool operator==(const OnnxPort&) const = default;
};

struct OnnxModel {
  std::vector<OnnxPort> inputs = {};
  OnnxPort output = {};
  std::vector<OnnxNode> nodes = {};
  std::map<std::string, OnnxTensor> constants = {};
  std::map<std::string, std::string> metadata = {};  // free text by key, for people and tools

  bool operator==(const OnnxModel&) const = default;
};

// Encodes the model as the bytes of a file. The same model gives the same bytes. Throws Error if
// the model is too large for the format (2 GB).
std::string WriteOnnx(const OnnxModel& model);

// Decodes bytes that WriteOnnx wrote. `source` names the bytes in errors. Throws Error on other
// bytes, for example on other operator sets or tensors of other types.
OnnxModel ReadOnnx(std::string_view bytes, const std::string& source);

}  // namespace shoal::launch
