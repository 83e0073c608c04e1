// SPDX-License-Identifier: Apache-2.0
// Copies from a device to the host for which neither the host nor later commands wait. Each copy
// has host memory of its own, which a later copy uses again.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>

#include "learner/device/device.h"

namespace shoal::learner::device {

// Not movable. One thread. Throws the errors of the device.
class HostCopies {
 public:
  // A copy on its way. Its destruction releases the host memory. Must not outlive the HostCopies.
  class Copy {
   public:
    virtual ~Copy() = default;
    // Waits until the copy is complete. Returns its bytes, which are valid as long as this object.
    virtual const void* Wait() const = 0;
  };

  // Borrows the device.
  explicit HostCopies(Device* device) : device_(device) {}
  // Waits for the device, which may still write copies that were not read.
  ~HostCopies();
  HostCopies(const HostCopies&) = delete;
  HostCopies& operator=(const HostCopies&) = delete;

  // Begins a copy of `bytes` bytes behind the commands that the device has so far, and before later
  // ones. Returns at once, except that the first copies allocate host memory.
  std::shared_ptr<const Copy> Begin(const void* from, int64_t bytes);

  size_t memories() const { return memories_.size(); }  // allocations of host memory so far

 private:
  struct Memory {
    void* host;
    int64_t bytes;
    std::unique_ptr<Event> arrived;
    bool used;
  };
  class CopyInMemory;

  Memory* TakeMemory(int64_t bytes);

  Device* const device_;
  std::deque<Memory> memories_;
};

}  // namespace shoal::learner::device
