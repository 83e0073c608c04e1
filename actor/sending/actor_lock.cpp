#include "actor/sending/actor_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <thread>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/run_folder/run_file_names.h"

namespace shoal::actor {

ActorLock::ActorLock(const std::filesystem::path& run, uint32_t actor,
                     std::chrono::seconds deadline, const std::function<bool()>& stop) {
  MakeFolders(run / kMadeFolder);
  const std::filesystem::path path = run / kMadeFolder / fmt::format("actor-{}.lock", actor);
  fd_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (fd_ < 0) throw RuntimeError("cannot write '{}': {}", path.string(), std::strerror(errno));
  const SteadyTime end = Now() + deadline;
  while (flock(fd_, LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    if (error != EWOULDBLOCK && error != EINTR) {
      close(fd_);
      throw RuntimeError("cannot lock '{}': {}", path.string(), std::strerror(error));
    }
    if (Now() >= end || stop()) {
      close(fd_);
      throw RuntimeError("actor {} of this run is running already: another process holds '{}'",
                         actor, path.string());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

ActorLock::~ActorLock() { close(fd_); }

}  // namespace shoal::actor
