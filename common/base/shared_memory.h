// SPDX-License-Identifier: Apache-2.0
// Memory that processes of one user on one host share. The memory has no name in any file system,
// so it cannot collide with memory of another run, and the size of /dev/shm does not matter. The
// kernel frees the memory after the process that made it and all processes that map it have ended,
// for whatever reason.
//
// A reader opens the memory through /proc, by the process number and the descriptor of the process
// that made it. This process must be alive at that time; a mapping stays valid afterwards. The
// kernel admits only the same user and root. The size of the memory is sealed, so that no access
// can fail later.
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
  // Makes memory of `bytes` zeros and allocates all of the memory now. `label` appears in
  // /proc/PID/maps. Throws Error with the reason: a limit on the size of files, too little memory,
  // or a kernel without memfd_create. If the memory limit of a control group is too small, the
  // kernel kills the process; the caller must check this limit before the call.
  static SharedMemory Make(const std::string& label, uint64_t bytes);
  // Makes memory that contains the concatenated `pieces` and is sealed against changes. Other
  // processes can Open the memory while the returned descriptor is open. This function writes the
  // pieces without a mapping, which costs about half as much as Make and a copy. Throws Error like
  // Make.
  static Descriptor MakeOf(const std::string& label,
                           std::initializer_list<std::string_view> pieces);
  enum class Access { kRead, kReadAndWrite };
  // Maps the memory of a process on this host. Throws Error if there is no such memory, if the
  // caller has no access to it, or if the memory was not made by this class or does not have
  // `bytes` bytes.
  static SharedMemory Open(int32_t pid, int32_t descriptor, uint64_t bytes,
                           Access access = Access::kRead);

  SharedMemory(SharedMemory&& other) noexcept
      : descriptor_(std::move(other.descriptor_)),
        data_(std::exchange(other.data_, nullptr)),
        bytes_(other.bytes_) {}
  SharedMemory& operator=(SharedMemory&&) = delete;
  ~SharedMemory();

  // The mapping, aligned to a page. If the memory was mapped for reading, a write ends the
  // process (SIGSEGV).
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
