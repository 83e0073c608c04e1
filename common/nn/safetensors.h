// SPDX-License-Identifier: Apache-2.0
// safetensors files: u64 LE header length, JSON header, raw little-endian row-major data.
// Format: github.com/huggingface/safetensors; a reader checks every offset against shape and size.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace shoal::nn {

struct NamedTensor {
  std::string dtype;  // "F32", "BF16", "U64", "U8"; "I64" for PyTorch's counters
  std::vector<int64_t> shape;
  std::vector<uint8_t> data;
};

using TensorMap = std::map<std::string, NamedTensor>;

// A tensor whose bytes it borrows, row-major and without alignment.
struct TensorView {
  std::string dtype;
  std::vector<int64_t> shape;
  std::span<const uint8_t> data;
};

// Parameter type of functions that read tensors: a TensorMap converts to it. Like a string_view, it
// owns nothing.
class TensorViews {
 public:
  TensorViews() = default;
  TensorViews(const TensorMap& tensors);

  // Null if there is no tensor of this name.
  const TensorView* Find(const std::string& name) const;
  const std::map<std::string, TensorView>& all() const& { return views_; }

 private:
  friend TensorViews ReadSafetensorsViews(std::string_view bytes, const std::string& source);

  std::map<std::string, TensorView> views_;
};

// The bytes of a file holding `tensors` and the string pairs `metadata`.
std::string WriteSafetensors(const TensorMap& tensors,
                             const std::map<std::string, std::string>& metadata);

// `source` names the bytes in errors. Throws Error if the file is not well-formed.
TensorMap ReadSafetensors(std::string_view bytes, const std::string& source);
// The same, with the same checks, but without a copy of the data: the views point into `bytes`.
TensorViews ReadSafetensorsViews(std::string_view bytes, const std::string& source);

// Rounds F32 tensors to BF16 (nearest even), for messages. Running statistics, including
// observation.*, stay F32: if a mean is large compared with its deviation, BF16 is too coarse.
TensorMap ToBf16(TensorMap tensors);

}  // namespace shoal::nn
