// SPDX-License-Identifier: Apache-2.0
#include "common/nn/tensor_words.h"

#include <cstring>

#include "common/base/error.h"

namespace shoal::nn {

NamedTensor WordsTensor(const std::vector<uint64_t>& words) {
  NamedTensor tensor{.dtype = "U64", .shape = {int64_t(words.size())}, .data = {}};
  tensor.data.resize(words.size() * sizeof(uint64_t));
  if (!words.empty()) std::memcpy(tensor.data.data(), words.data(), tensor.data.size());
  return tensor;
}

std::vector<uint64_t> ReadWords(const TensorMap& tensors, const std::string& name,
                                std::optional<size_t> count, const std::string& source) {
  const auto found = tensors.find(name);
  if (found == tensors.end()) throw RuntimeError("{}: tensor {} is missing", source, name);
  const NamedTensor& tensor = found->second;
  const bool fits = tensor.dtype == "U64" && tensor.shape.size() == 1 &&
                    tensor.data.size() == size_t(tensor.shape[0]) * sizeof(uint64_t);
  if (!fits || (count && tensor.shape[0] != int64_t(*count))) {
    throw RuntimeError("{}: tensor {} is {} of {} bytes, expected {} U64", source, name,
                       tensor.dtype, tensor.data.size(),
                       count ? std::to_string(*count) : std::string("a row of"));
  }
  std::vector<uint64_t> words(size_t(tensor.shape[0]));
  if (!words.empty()) std::memcpy(words.data(), tensor.data.data(), tensor.data.size());
  return words;
}

void ExportCounter(const std::string& name, uint64_t value, TensorMap* tensors) {
  (*tensors)[name] = WordsTensor({value});
}

uint64_t ImportCounter(const TensorMap& tensors, const std::string& name,
                       const std::string& source) {
  return ReadWords(tensors, name, 1, source)[0];
}

}  // namespace shoal::nn
