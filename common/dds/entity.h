// SPDX-License-Identifier: Apache-2.0
// Owner of one DDS entity. Internal. Include the dds headers last, because they redefine `restrict`
// in C++.
#pragma once

#include <chrono>
#include <string>
#include <utility>

#include "common/base/error.h"
#include "common/base/watchdog.h"
// clang-format off
#include "dds/dds.h"
// clang-format on

namespace shoal::dds {

// Move-only; 0 = empty. Deleting an entity deletes its children and waits for running listeners.
class Entity {
 public:
  Entity() = default;
  // Takes the return value of a dds_create_* call. Throws Error naming `what` if the call failed.
  Entity(dds_entity_t handle, const std::string& what) : handle_(handle) {
    if (handle < 0) throw RuntimeError("DDS cannot create {}: {}", what, dds_strretcode(-handle));
  }
  ~Entity() { Reset(); }
  Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  Entity& operator=(Entity&& other) noexcept {
    if (this != &other) {
      Reset();
      handle_ = std::exchange(other.handle_, 0);
    }
    return *this;
  }

  dds_entity_t get() const { return handle_; }
  explicit operator bool() const { return handle_ > 0; }
  // Deletes the entity. dds_delete sometimes hangs if a peer leaves at the same time. The watchdog
  // then ends the process.
  void Reset() {
    if (handle_ > 0) {
      const Watchdog watchdog("deleting a DDS entity", kDeleteLimit);
      dds_delete(handle_);
    }
    handle_ = 0;
  }

 private:
  static constexpr std::chrono::seconds kDeleteLimit{30};

  dds_entity_t handle_ = 0;
};

}  // namespace shoal::dds
