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

// View of a tensor. Borrows the bytes, which are row-major and may be unaligned.
struct TensorView {
  std::string dtype;
  std::vector<int64_t> shape;
  std::span<const uint8_t> data;
};

// Parameter type of functions that read tensors. A TensorMap converts to TensorViews. TensorViews
// own nothing, like a string_view.
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

// Returns the bytes of a file that contains `tensors` and the string pairs `metadata`.
std::string WriteSafetensors(const TensorMap& tensors,
                             const std::map<std::string, std::string>& metadata);

// `source` names the bytes in errors. Throws Error if the file is not well-formed.
TensorMap ReadSafetensors(std::string_view bytes, const std::string& source);
// Does the same, with the same checks, but without a copy of the data: the views point into
// `bytes`.
TensorViews ReadSafetensorsViews(std::string_view bytes, const std::string& source);

// Rounds F32 tensors to BF16 (nearest, ties to even), for messages. Running statistics, including
// observation.*, stay F32, because BF16 is too coarse for a mean that is large compared with its
// deviation.
TensorMap ToBf16(TensorMap tensors);

}  // namespace shoal::nn
