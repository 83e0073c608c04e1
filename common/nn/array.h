// SPDX-License-Identifier: Apache-2.0
// Handles of arrays, as an algorithm passes them between modules and operations. The numbers are in
// the memory of the engine that computes with them.
//
// A handle says how many numbers there are and nothing of what they are: only the engine looks
// inside (common/nn/host_memory.h for the engine of the CPU), so the numbers may be in the
// memory of a card. A handle is copied like a pointer and owns nothing.
#pragma once

#include <cstdint>

namespace shoal::nn {

template <class T>
class ArrayOf {
 public:
  ArrayOf() = default;  // none

  explicit operator bool() const { return data_ != nullptr; }
  int64_t size() const { return size_; }
  // Whether both are the same numbers, not equal ones.
  bool operator==(const ArrayOf&) const = default;

 private:
  friend struct HostMemory;
  ArrayOf(T* data, int64_t size) : data_(data), size_(size) {}

  T* data_ = nullptr;
  int64_t size_ = 0;
};

using Array = ArrayOf<float>;     // row-major
using Frames = ArrayOf<uint8_t>;  // stacks of frames (B, K*C, H, W)
using Number = ArrayOf<double>;   // one number: a loss, a temperature, a sum of squares

}  // namespace shoal::nn
