// SPDX-License-Identifier: Apache-2.0
#include "common/config/run_membership.h"

#include <fcntl.h>

#include <cerrno>
#include <cstring>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/run_folder/run_file_names.h"

namespace shoal {
namespace {

struct flock WholeFile(short type) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  return lock;
}

}  // namespace

RunMembership::RunMembership(const std::filesystem::path& run)
    : file_(OpenRegular(run / kMembersFile, O_RDWR | O_CREAT)) {
  struct flock shared = WholeFile(F_RDLCK);
  if (fcntl(file_.get(), F_SETLK, &shared) == 0) return;
  throw RuntimeError("cannot lock '{}': {}", (run / kMembersFile).string(), std::strerror(errno));
}

std::optional<pid_t> AnyMember(const std::filesystem::path& run) {
  const std::filesystem::path file = run / kMembersFile;
  const Descriptor opened(open(file.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK));
  if (opened.get() < 0) {
    if (errno == ENOENT) return std::nullopt;
    throw RuntimeError("cannot open '{}': {}", file.string(), std::strerror(errno));
  }
  struct flock exclusive = WholeFile(F_WRLCK);
  if (fcntl(opened.get(), F_GETLK, &exclusive) != 0) {
    throw RuntimeError("cannot ask for '{}': {}", file.string(), std::strerror(errno));
  }
  if (exclusive.l_type == F_UNLCK) return std::nullopt;
  return exclusive.l_pid;
}

}  // namespace shoal
