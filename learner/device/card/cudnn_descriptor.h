// SPDX-License-Identifier: Apache-2.0
// A descriptor of cuDNN's graph interface, which is destroyed with its owner.
#pragma once

#include <cudnn.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "learner/device/card/cuda_error.h"

namespace shoal::learner::device {

// Throws Error (kDevice).
class Descriptor {
 public:
  explicit Descriptor(cudnnBackendDescriptorType_t type) {
    Require(cudnnBackendCreateDescriptor(type, &descriptor_), kWhat);
  }
  ~Descriptor() {
    if (descriptor_ != nullptr) cudnnBackendDestroyDescriptor(descriptor_);
  }
  Descriptor(Descriptor&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, nullptr)) {}
  Descriptor& operator=(Descriptor&&) = delete;

  cudnnBackendDescriptor_t get() const { return descriptor_; }

  template <class T>
  void Set(cudnnBackendAttributeName_t name, cudnnBackendAttributeType_t type,
           const std::vector<T>& values) {
    Require(cudnnBackendSetAttribute(descriptor_, name, type, static_cast<int64_t>(values.size()),
                                     values.data()),
            kWhat);
  }
  void Set(cudnnBackendAttributeName_t name, const std::vector<int64_t>& values) {
    Set(name, CUDNN_TYPE_INT64, values);
  }
  void Set(cudnnBackendAttributeName_t name, const Descriptor& other) {
    const cudnnBackendDescriptor_t value = other.get();
    Require(cudnnBackendSetAttribute(descriptor_, name, CUDNN_TYPE_BACKEND_DESCRIPTOR, 1, &value),
            kWhat);
  }
  void Finalize() { Require(TryFinalize(), kWhat); }
  cudnnStatus_t TryFinalize() { return cudnnBackendFinalize(descriptor_); }

 private:
  static constexpr char kWhat[] = "preparing a convolution";

  cudnnBackendDescriptor_t descriptor_ = nullptr;
};

}  // namespace shoal::learner::device
