// SPDX-License-Identifier: Apache-2.0
// Memory that processes of one user on one host share. It has no name in any file system: once its
// maker and all processes that have it mapped have ended, for whatever reason, it is freed. It
// cannot collide with memory of another run, and the size of /dev/shm does not matter.
//
// A reader finds it by the maker's process number and descriptor, through /proc, while the maker
// lives; a mapping stays valid afterwards. The kernel admits only the maker's user and root.
// The size is sealed, so that no access can fail later.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "common/base/descriptor.h"

namespace shoal {

class SharedMemory {
 public:
  // `bytes` of zeros, taken from the system at once. `label` shows in /proc/PID/maps. Throws Error
  // with the reason: a limit on files' sizes, no memory, a kernel without memfd_create. A control
  // group with too little room kills instead: the caller asks before.
  static SharedMemory Make(const std::string& label, uint64_t bytes);
  // Memory with the concatenated `pieces`, sealed against changes. Others can Open it as long as
  // the descriptor is kept. It is written without being mapped, which costs about half of Make and
  // a copy into it. Throws Error as Make does.
  static Descriptor MakeOf(const std::string& label,
                           std::initializer_list<std::string_view> pieces);
  // That of a process on this host, for reading. Throws Error: nothing there, not ours to read,
  // not made here, of another size.
  static SharedMemory Open(int32_t pid, int32_t descriptor, uint64_t bytes);

  SharedMemory(SharedMemory&& other) noexcept
      : descriptor_(std::move(other.descriptor_)),
        data_(std::exchange(other.data_, nullptr)),
        bytes_(other.bytes_) {}
  SharedMemory& operator=(SharedMemory&&) = delete;
  ~SharedMemory();

  // Aligned to a page. A write to what was opened ends the process (SIGSEGV).
  uint8_t* data() const { return data_; }
  uint64_t bytes() const { return bytes_; }
  int descriptor() const { return descriptor_.get(); }

 private:
  SharedMemory(Descriptor descriptor, uint8_t* data, uint64_t bytes)
      : descriptor_(std::move(descriptor)), data_(data), bytes_(bytes) {}

  Descriptor descriptor_;
  uint8_t* data_;
  const uint64_t bytes_;
};

}  // namespace shoal
