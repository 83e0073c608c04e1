// SPDX-License-Identifier: Apache-2.0
// Arrays of the CPU's engine, which are in host memory. Only that engine and tests include this
// header; algorithms do not.
#pragma once

#include <span>
#include <type_traits>
#include <vector>

#include "common/nn/array.h"

namespace shoal::nn {

struct HostMemory {
  // Returns a handle that borrows `values`.
  template <class T>
  static ArrayOf<std::remove_const_t<T>> Handle(std::span<T> values) {
    return {const_cast<std::remove_const_t<T>*>(values.data()), int64_t(values.size())};
  }
  template <class T>
  static std::span<T> Values(const ArrayOf<T>& array) {
    return {array.data_, size_t(array.size_)};
  }
};

// Returns a handle that borrows the numbers of a vector or span. If these numbers are const,
// nothing may write through the handle.
template <class Values>
auto HostArray(Values&& values) {
  return HostMemory::Handle(std::span(values));
}

template <class T>
std::span<T> HostValues(const ArrayOf<T>& array) {
  return HostMemory::Values(array);
}

}  // namespace shoal::nn
