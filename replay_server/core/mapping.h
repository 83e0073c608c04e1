// SPDX-License-Identifier: Apache-2.0
// A stretch of mapped memory: a file of its own or anonymous.
#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>

#include "common/base/descriptor.h"

namespace shoal::replay {

enum class Access { kReadOnly, kReadWrite };

// Owns the mapping and, for a file, its descriptor with an exclusive lock when writable: of the
// very descriptor that is mapped (flock), where FileLock would lock whatever the path names by
// then. Move-only.
class Mapping {
 public:
  Mapping() = default;
  ~Mapping();
  Mapping(Mapping&& other) noexcept { *this = std::move(other); }
  Mapping& operator=(Mapping&& other) noexcept;

  // Zeroed memory of this process. Throws Error when there is no room (storage_limits.h).
  static Mapping Anonymous(uint64_t bytes);
  // A new file of zeros, every block reserved, so that a later write cannot fail. Throws
  // Error, and leaves no file, when there is no room. A file of that name is replaced.
  static Mapping NewFile(const std::filesystem::path& path, uint64_t bytes);
  // All of an existing file. Throws Error when it cannot be opened, is empty, or, for kReadWrite,
  // another process has it open for writing.
  static Mapping OpenFile(const std::filesystem::path& path, Access access);

  uint8_t* data() const { return data_; }
  uint64_t size() const { return size_; }

 private:
  uint8_t* data_ = nullptr;
  uint64_t size_ = 0;
  Descriptor file_;
};

}  // namespace shoal::replay
