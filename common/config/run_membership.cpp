#include "common/config/run_membership.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "common/base/error.h"
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
    : fd_(open((run / kMembersFile).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
  struct flock shared = WholeFile(F_RDLCK);
  if (fd_ >= 0 && fcntl(fd_, F_SETLK, &shared) == 0) return;
  const int error = errno;
  if (fd_ >= 0) close(fd_);
  throw RuntimeError("cannot lock '{}': {}", (run / kMembersFile).string(), std::strerror(error));
}

RunMembership::~RunMembership() { close(fd_); }

std::optional<pid_t> AnyMember(const std::filesystem::path& run) {
  const std::filesystem::path file = run / kMembersFile;
  const int fd = open(file.c_str(), O_RDWR | O_CLOEXEC);
  if (fd < 0) {
    if (errno == ENOENT) return std::nullopt;
    throw RuntimeError("cannot open '{}': {}", file.string(), std::strerror(errno));
  }
  struct flock exclusive = WholeFile(F_WRLCK);
  const int result = fcntl(fd, F_GETLK, &exclusive);
  const int error = errno;
  close(fd);
  if (result != 0)
    throw RuntimeError("cannot ask for '{}': {}", file.string(), std::strerror(error));
  if (exclusive.l_type == F_UNLCK) return std::nullopt;
  return exclusive.l_pid;
}

}  // namespace shoal
