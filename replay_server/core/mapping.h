// SPDX-License-Identifier: Apache-2.0
// Mapped memory: a file or anonymous.
#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>

#include "common/base/descriptor.h"

namespace shoal::replay {

enum class Access { kReadOnly, kReadWrite };

// Owns the mapping and, for a file, its descriptor. A writable file is locked exclusively with
// flock on the mapped descriptor; FileLock would lock the file that the path names at that time,
// which may be another one. Move-only.
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
  // Maps a whole existing file. Throws Error if the file cannot be opened or is empty, or, for
  // kReadWrite, if another process has the file open for writing.
  static Mapping OpenFile(const std::filesystem::path& path, Access access);

  uint8_t* data() const { return data_; }
  uint64_t size() const { return size_; }

 private:
  uint8_t* data_ = nullptr;
  uint64_t size_ = 0;
  Descriptor file_;
};

}  // namespace shoal::replay
