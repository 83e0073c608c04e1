// SPDX-License-Identifier: Apache-2.0
#include "actor/hosted/element_conversion.h"

#include <cstdint>

namespace shoal::hosted {
namespace {

using tasks::ElementType;

template <class T>
void Convert(const void* array, std::span<float> numbers) {
  const T* from = static_cast<const T*>(array);
  for (size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(from[i]);
}

}  // namespace

void ConvertTo(ElementType type, const void* array, std::span<float> numbers) {
  switch (type) {
    case ElementType::kFloat32:
      return Convert<float>(array, numbers);
    case ElementType::kFloat64:
      return Convert<double>(array, numbers);
    case ElementType::kUint8:
      return Convert<uint8_t>(array, numbers);
    case ElementType::kUint16:
      return Convert<uint16_t>(array, numbers);
    case ElementType::kUint32:
      return Convert<uint32_t>(array, numbers);
    case ElementType::kInt8:
      return Convert<int8_t>(array, numbers);
    case ElementType::kInt16:
      return Convert<int16_t>(array, numbers);
    case ElementType::kInt32:
      return Convert<int32_t>(array, numbers);
    case ElementType::kInt64:
      return Convert<int64_t>(array, numbers);
  }
}

std::vector<float> ToFloats(ElementType type, const void* array, size_t count) {
  std::vector<float> numbers(count);
  ConvertTo(type, array, numbers);
  return numbers;
}

}  // namespace shoal::hosted
