// SPDX-License-Identifier: Apache-2.0
#include "common/base/file_lock.h"

#include <fcntl.h>

#include <cerrno>
#include <cstring>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/sleep.h"

namespace shoal {
namespace {

constexpr std::chrono::milliseconds kPoll{20};

struct flock WholeFile(Holding holding) {
  struct flock lock {};
  lock.l_type = holding == Holding::kAlone ? F_WRLCK : F_RDLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

}  // namespace

std::optional<FileLock> FileLock::Take(const std::filesystem::path& path, Holding holding) {
  Descriptor file = OpenRegular(path, O_RDWR | O_CREAT);
  struct flock lock = WholeFile(holding);
  if (fcntl(file.get(), F_OFD_SETLK, &lock) == 0) return FileLock(std::move(file));
  if (errno == EAGAIN || errno == EACCES) return std::nullopt;
  throw RuntimeError("cannot lock '{}': {}", path.string(), std::strerror(errno));
}

std::optional<FileLock> FileLock::Take(const std::filesystem::path& path, Holding holding,
                                       std::chrono::milliseconds deadline) {
  const SteadyTime end = Now() + deadline;
  while (true) {
    if (auto lock = Take(path, holding)) return lock;
    if (Now() >= end) return std::nullopt;
    SleepFor(kPoll);
  }
}

bool IsLocked(const std::filesystem::path& path) {
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) return false;
  struct flock lock = WholeFile(Holding::kAlone);
  return fcntl(file.get(), F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

}  // namespace shoal
