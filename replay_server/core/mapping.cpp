// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/mapping.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "common/base/disk_steps.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "replay_server/core/storage_limits.h"

namespace shoal::replay {
namespace {

namespace fs = std::filesystem;

// Calls mmap. On failure, returns nullptr and sets errno.
uint8_t* Map(int fd, uint64_t bytes, Access access) {
  const int protection = access == Access::kReadWrite ? PROT_READ | PROT_WRITE : PROT_READ;
  const int flags = fd < 0 ? MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE : MAP_SHARED;
  void* data = mmap(nullptr, bytes, protection, flags, fd, 0);
  return data == MAP_FAILED ? nullptr : static_cast<uint8_t*>(data);
}

// Removes a file that could not be completed, then throws.
[[noreturn]] void FailNewFile(const fs::path& path, uint64_t bytes, int error) {
  unlink(path.c_str());
  throw RuntimeError("cannot reserve {} bytes for the replay file '{}': {}", bytes, path.string(),
                     std::strerror(error));
}

}  // namespace

Mapping::~Mapping() {
  if (data_ != nullptr) munmap(data_, size_);
}

Mapping& Mapping::operator=(Mapping&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(file_, other.file_);
  return *this;
}

Mapping Mapping::Anonymous(uint64_t bytes) {
  CheckMemoryRoom(bytes);
  Mapping mapping;
  mapping.data_ = Map(-1, bytes, Access::kReadWrite);
  if (mapping.data_ == nullptr) {
    throw RuntimeError("cannot map {} bytes of memory for the replay: {}", bytes,
                       std::strerror(errno));
  }
  mapping.size_ = bytes;
  // Frames are read at random, so large pages save most of the address translation.
  madvise(mapping.data_, bytes, MADV_HUGEPAGE);
  return mapping;
}

Mapping Mapping::NewFile(const fs::path& path, uint64_t bytes) {
  std::error_code ignored;
  fs::remove(path, ignored);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  CheckDiskRoom(folder, bytes);
  Mapping mapping;
  mapping.file_ = Descriptor(open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  const int fd = mapping.file_.get();
  if (fd < 0) {
    throw RuntimeError("cannot create the replay file '{}': {}", path.string(),
                       std::strerror(errno));
  }
  int error = DiskStep(path);
  if (error == 0) error = posix_fallocate(fd, 0, static_cast<off_t>(bytes));
  if (error != 0) FailNewFile(path, bytes, error);
  if (flock(fd, LOCK_EX | LOCK_NB) != 0) FailNewFile(path, bytes, errno);
  mapping.data_ = Map(fd, bytes, Access::kReadWrite);
  if (mapping.data_ == nullptr) FailNewFile(path, bytes, errno);
  mapping.size_ = bytes;
  return mapping;
}

Mapping Mapping::OpenFile(const fs::path& path, Access access) {
  const bool writable = access == Access::kReadWrite;
  Mapping mapping;
  mapping.file_ = OpenRegular(path, writable ? O_RDWR : O_RDONLY);
  const int fd = mapping.file_.get();
  if (writable && flock(fd, LOCK_EX | LOCK_NB) != 0) {
    throw RuntimeError("the replay file '{}' is in use by another replay server", path.string());
  }
  struct stat status {};
  if (fstat(fd, &status) != 0 || status.st_size <= 0) {
    throw RuntimeError("the replay file '{}' is empty", path.string());
  }
  const uint64_t bytes = static_cast<uint64_t>(status.st_size);
  mapping.data_ = Map(fd, bytes, access);
  if (mapping.data_ == nullptr) {
    throw RuntimeError("cannot map the replay file '{}': {}", path.string(), std::strerror(errno));
  }
  mapping.size_ = bytes;
  return mapping;
}

}  // namespace shoal::replay
