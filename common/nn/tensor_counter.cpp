#include "common/nn/tensor_counter.h"

#include <cstring>

#include "common/base/error.h"

namespace shoal::nn {

void ExportCounter(const std::string& name, uint64_t value, TensorMap* tensors) {
  NamedTensor tensor{"U64", {1}, std::vector<uint8_t>(sizeof(value))};
  std::memcpy(tensor.data.data(), &value, sizeof(value));
  (*tensors)[name] = std::move(tensor);
}

uint64_t ImportCounter(const TensorMap& tensors, const std::string& name,
                       const std::string& source) {
  const auto found = tensors.find(name);
  if (found == tensors.end()) throw RuntimeError("{}: tensor {} is missing", source, name);
  const NamedTensor& tensor = found->second;
  uint64_t value = 0;
  if (tensor.dtype != "U64" || tensor.shape != std::vector<int64_t>{1} ||
      tensor.data.size() != sizeof(value)) {
    throw RuntimeError("{}: tensor {} is {}, expected one U64", source, name, tensor.dtype);
  }
  std::memcpy(&value, tensor.data.data(), sizeof(value));
  return value;
}

}  // namespace shoal::nn
