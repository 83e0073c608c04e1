// SPDX-License-Identifier: Apache-2.0
// Memory that processes of one user on one host share. The memory has no name in any file system.
// The kernel frees the memory when its maker and all processes that map the memory have ended, for
// whatever reason. It cannot collide with memory of another run, and the size of /dev/shm does not
// matter.
//
// While the maker lives, a reader opens the memory through /proc by the maker's process number and
// descriptor. A mapping stays valid afterwards. The kernel admits only the maker's user and root.
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
  // Makes memory of `bytes` zeros, all allocated at once. `label` appears in /proc/PID/maps. Throws
  // Error with the reason: a limit on the size of files, no memory, a kernel without memfd_create.
  // If the memory limit of a control group is too small, the kernel kills the process; the caller
  // must check the limit before.
  static SharedMemory Make(const std::string& label, uint64_t bytes);
  // Makes memory with the concatenated `pieces`, sealed against changes. Other processes can Open
  // the memory while the descriptor is open. The pieces are written without a mapping, at about
  // half the cost of Make and a copy. Throws Error as Make does.
  static Descriptor MakeOf(const std::string& label,
                           std::initializer_list<std::string_view> pieces);
  // Maps, for reading, the memory of a process on this host. Throws Error if there is no such
  // memory, the caller may not read it, it was not made by this class, or it has another size.
  static SharedMemory Open(int32_t pid, int32_t descriptor, uint64_t bytes);

  SharedMemory(SharedMemory&& other) noexcept
      : descriptor_(std::move(other.descriptor_)),
        data_(std::exchange(other.data_, nullptr)),
        bytes_(other.bytes_) {}
  SharedMemory& operator=(SharedMemory&&) = delete;
  ~SharedMemory();

  // The mapping, aligned to a page. If the memory was mapped by Open, a write ends the process
  // (SIGSEGV).
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
