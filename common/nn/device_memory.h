// SPDX-License-Identifier: Apache-2.0
// Arrays of an engine that computes in the memory of a device. Only such an engine and tests
// include this header. The addresses are those of the device; the host must not read them.
#pragma once

#include "common/nn/array.h"

namespace shoal::nn {

struct DeviceMemory {
  template <class T>
  static ArrayOf<T> Handle(T* address, int64_t size) {
    return {address, size};
  }
  template <class T>
  static T* Address(const ArrayOf<T>& array) {
    return array.data_;
  }
};

// Returns a handle that borrows `size` numbers at an address of the device.
template <class T>
ArrayOf<T> DeviceArray(T* address, int64_t size) {
  return DeviceMemory::Handle(address, size);
}

// Null: no array.
template <class T>
T* AddressOf(const ArrayOf<T>& array) {
  return DeviceMemory::Address(array);
}

}  // namespace shoal::nn
