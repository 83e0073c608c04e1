// SPDX-License-Identifier: Apache-2.0
// Handles of arrays. An algorithm passes handles between modules and operations. The values are in
// the memory of the engine that computes with the array.
//
// A handle gives the number of values, but no access to the values. Only the engine reads the
// values (common/nn/host_memory.h for the engine of the CPU), so the values may be in the memory of
// a GPU. A handle is copied like a pointer and owns nothing.
#pragma once

#include <cstdint>

namespace shoal::nn {

template <class T>
class ArrayOf {
 public:
  ArrayOf() = default;  // no array

  explicit operator bool() const { return data_ != nullptr; }
  int64_t size() const { return size_; }
  // Whether both handles refer to the same memory; the values are not compared.
  bool operator==(const ArrayOf&) const = default;

 private:
  friend struct HostMemory;
  friend struct DeviceMemory;
  ArrayOf(T* data, int64_t size) : data_(data), size_(size) {}

  T* data_ = nullptr;
  int64_t size_ = 0;
};

using Array = ArrayOf<float>;     // row-major
using Frames = ArrayOf<uint8_t>;  // B stacks of K frames (C, H, W): (B, K*C, H, W)
using Number = ArrayOf<double>;   // one number: a loss, a temperature, a sum of squares

}  // namespace shoal::nn
