// SPDX-License-Identifier: Apache-2.0
// Inputs of one update in the memory of a device: the batch, random draws and numbers of the host.
// Two landings take turns, so that the inputs of an update arrive while the update before computes.
//
// Inputs of an update get the same addresses as the inputs of an earlier update of this landing, if
// they have the same sizes in the same order.
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "learner/device/device.h"

namespace shoal::learner::device {

// Not movable. One thread.
class Landing {
 public:
  // Borrows the device.
  explicit Landing(Device* device);
  ~Landing();
  Landing(const Landing&) = delete;
  Landing& operator=(const Landing&) = delete;

  // Begins the inputs of an update. Waits until the host's memory of this landing is free.
  void Begin();
  // Copies values of the host. Returns their address on the device, where they arrive with Send.
  template <class T>
  T* Add(std::span<const T> values) {
    const Place place = NewPlace(int64_t(values.size_bytes()));
    if (!values.empty()) std::memcpy(place.host, values.data(), values.size_bytes());
    return static_cast<T*>(place.device);
  }
  // Starts a copy of the caller's memory, which must not change before Arrive. Returns the address
  // on the device.
  uint8_t* Borrow(std::span<const uint8_t> bytes);
  // Starts the copies of all values that Add has taken. Later commands of the device run when all
  // inputs have arrived.
  void Send();
  // Waits until the device has read the memory that Borrow was given.
  void Arrive() { device_->Wait(*arrived_); }
  // Says that commands which read the inputs have been submitted.
  void MarkUsed() { device_->Mark(Lane::kCommands, used_.get()); }

 private:
  struct Place {
    void *host, *device;
  };
  // Memory of the host and of the device.
  struct Chunk {
    uint8_t *host, *device;
    int64_t bytes, used;
  };
  struct Borrowed {
    uint8_t* device;
    int64_t bytes;
  };

  Place NewPlace(int64_t bytes);

  Device* const device_;
  const std::unique_ptr<Event> arrived_, used_;
  std::vector<Chunk> chunks_;
  size_t chunk_ = 0;  // in which the next values are placed
  std::vector<Borrowed> borrowed_;
  size_t next_borrowed_ = 0;
};

}  // namespace shoal::learner::device
