// SPDX-License-Identifier: Apache-2.0
// Memory of a device and the list of commands of the current update, which the parts of an engine
// share.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/base/error.h"
#include "common/nn/precision.h"
#include "learner/device/commands.h"
#include "learner/device/device.h"
#include "learner/device/host_copies.h"

namespace shoal::learner::device {

// Not movable. One thread. The memory lives as long as the workspace, which outlives the parts.
class Workspace {
 public:
  // Borrows the device. batch: rows of each network (B).
  Workspace(Device* device, nn::Precision precision, int batch);
  ~Workspace();
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  Device* device() const { return device_; }
  HostCopies& host_copies() const { return *host_copies_; }
  int batch() const { return batch_; }
  // Type of large products and convolutions, and of the maps between them.
  Type compute_type() const { return compute_type_; }
  // Channels of a map of `channels` channels, with the padding that the device needs.
  int PaddedChannels(int channels) const;

  // Returns `count` numbers that are 0; null if count is 0.
  template <class T>
  T* New(int64_t count) {
    return static_cast<T*>(NewBytes(count * int64_t(sizeof(T))));
  }

  // Appends the command to the list of the current update. Runs it at once if there is no update.
  void Add(const Command& command);
  // Begins a list whose first command is `first`.
  void BeginList(const Command& first);
  // Ends the list, with `first` as its first command. Returns the list, which is valid until the
  // next BeginList.
  const CommandList& EndList(const Command& first);

 private:
  void* NewBytes(int64_t bytes);
  void* NewChunk(int64_t bytes);

  Device* const device_;
  const int batch_;
  const Type compute_type_;
  const std::unique_ptr<HostCopies> host_copies_;
  std::vector<void*> chunks_;
  uint8_t* free_ = nullptr;  // of the last chunk
  int64_t free_bytes_ = 0;
  CommandList list_;
  bool listing_ = false;
};

// Runs the work of a destructor, which cannot throw. If the device was lost, nothing is left to do.
template <class Work>
void Quietly(const Work& work) {
  try {
    work();
  } catch (const Error&) {
  }
}

// Returns `values` as an array of the type: one of the two addresses.
inline const void* As(Type type, const float* f32, const uint16_t* bf16) {
  return type == Type::kF32 ? static_cast<const void*>(f32) : bf16;
}
inline int64_t SizeOf(Type type) { return type == Type::kF32 ? 4 : 2; }

}  // namespace shoal::learner::device
