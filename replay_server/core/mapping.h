// SPDX-License-Identifier: Apache-2.0
// Mapped memory: a file, or anonymous memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>

#include "common/base/descriptor.h"

namespace shoal::replay {

enum class Access { kReadOnly, kReadWrite };

// Owns the mapping and, for a file, its descriptor. A writable file is locked exclusively with
// flock on the mapped descriptor. FileLock is not used, because it would lock the file that has the
// path at the time of the lock, which may be another file. Move-only.
class Mapping {
 public:
  Mapping() = default;
  ~Mapping();
  Mapping(Mapping&& other) noexcept { *this = std::move(other); }
  Mapping& operator=(Mapping&& other) noexcept;

  // Maps zeroed memory of this process. Throws Error if there is not enough memory
  // (storage_limits.h).
  static Mapping Anonymous(uint64_t bytes);
  // Maps a new file of zeros, which replaces an existing file. All blocks of the file are reserved,
  // so that a later write cannot fail. If there is not enough space, throws Error and leaves no
  // file.
  static Mapping NewFile(const std::filesystem::path& path, uint64_t bytes);
  // Maps a whole existing file. Throws Error if the file cannot be opened or is empty. For
  // kReadWrite, also throws Error if another process has the file open for writing.
  static Mapping OpenFile(const std::filesystem::path& path, Access access);

  uint8_t* data() const { return data_; }
  uint64_t size() const { return size_; }

 private:
  uint8_t* data_ = nullptr;
  uint64_t size_ = 0;
  Descriptor file_;
};

}  // namespace shoal::replay
