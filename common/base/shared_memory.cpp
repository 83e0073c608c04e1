// SPDX-License-Identifier: Apache-2.0
#include "common/base/shared_memory.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>

#include "common/base/error.h"

namespace shoal {
namespace {

constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL;

// The kernel ends a process that makes a file larger than this limit, even a file in memory.
void CheckFileSizeLimit(uint64_t bytes) {
  struct rlimit limit {};
  if (getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  if (limit.rlim_cur >= bytes) return;
  throw RuntimeError("shared memory of {} bytes: files may have {} bytes (ulimit -f)", bytes,
                     limit.rlim_cur);
}

bool WriteWhole(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) bytes.remove_prefix(static_cast<size_t>(written));
  }
  return true;
}

uint8_t* Map(int descriptor, uint64_t bytes, int protection, int flags) {
  void* data = mmap(nullptr, bytes, protection, MAP_SHARED | flags, descriptor, 0);
  if (data == MAP_FAILED) {
    throw RuntimeError("cannot map {} bytes of shared memory: {}", bytes, std::strerror(errno));
  }
  return static_cast<uint8_t*>(data);
}

}  // namespace

SharedMemory SharedMemory::Make(const std::string& label, uint64_t bytes) {
  CheckFileSizeLimit(bytes);
  Descriptor descriptor(memfd_create(label.c_str(), MFD_CLOEXEC | MFD_ALLOW_SEALING));
  const int fd = descriptor.get();
  // fallocate reserves the pages now, because a page that is missing later causes a SIGBUS.
  int error = 0;
  if (fd < 0 || fchmod(fd, S_IRUSR | S_IWUSR) != 0 ||
      ftruncate(fd, static_cast<off_t>(bytes)) != 0 || fcntl(fd, F_ADD_SEALS, kSeals) != 0) {
    error = errno;
  } else {
    error = posix_fallocate(fd, 0, static_cast<off_t>(bytes));
  }
  if (error != 0) {
    throw RuntimeError("cannot make {} bytes of shared memory: {}", bytes, std::strerror(error));
  }
  uint8_t* data = Map(fd, bytes, PROT_READ | PROT_WRITE, MAP_POPULATE);
  return {std::move(descriptor), data, bytes};
}

Descriptor SharedMemory::MakeOf(const std::string& label,
                                std::initializer_list<std::string_view> pieces) {
  uint64_t bytes = 0;
  for (const std::string_view piece : pieces) bytes += piece.size();
  CheckFileSizeLimit(bytes);
  Descriptor descriptor(memfd_create(label.c_str(), MFD_CLOEXEC | MFD_ALLOW_SEALING));
  const int fd = descriptor.get();
  // Writing allocates every page, so no page can be missing later and cause a SIGBUS.
  bool made = fd >= 0 && fchmod(fd, S_IRUSR | S_IWUSR) == 0;
  for (const std::string_view piece : pieces) made = made && WriteWhole(fd, piece);
  if (!made || fcntl(fd, F_ADD_SEALS, kSeals | F_SEAL_WRITE) != 0) {
    throw RuntimeError("cannot make {} bytes of shared memory: {}", bytes, std::strerror(errno));
  }
  return descriptor;
}

SharedMemory SharedMemory::Open(int32_t pid, int32_t descriptor, uint64_t bytes, Access access) {
  const bool writes = access == Access::kReadAndWrite;
  const std::string path = fmt::format("/proc/{}/fd/{}", pid, descriptor);
  // The path may name any kind of file, so opening it must neither wait nor take over a terminal.
  Descriptor opened(
      open(path.c_str(), (writes ? O_RDWR : O_RDONLY) | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (opened.get() < 0) {
    throw RuntimeError("cannot open shared memory '{}': {}", path, std::strerror(errno));
  }
  struct stat status {};
  const int seals = fcntl(opened.get(), F_GET_SEALS);
  if (seals < 0 || (seals & kSeals) != kSeals || fstat(opened.get(), &status) != 0) {
    throw RuntimeError("'{}' is no sealed shared memory", path);
  }
  if (static_cast<uint64_t>(status.st_size) != bytes) {
    throw RuntimeError("shared memory '{}' has {} bytes, expected {}", path, status.st_size, bytes);
  }
  uint8_t* data = Map(opened.get(), bytes, writes ? PROT_READ | PROT_WRITE : PROT_READ, 0);
  return {std::move(opened), data, bytes};
}

SharedMemory::~SharedMemory() {
  if (data_ != nullptr) munmap(data_, bytes_);
}

}  // namespace shoal
