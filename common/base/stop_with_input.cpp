#include "common/base/stop_with_input.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "common/base/error.h"
#include "common/base/stop.h"

namespace shoal {

StopWithInput::StopWithInput() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw RuntimeError("pipe: {}", std::strerror(errno));
  wake_read_ = ends[0];
  wake_write_ = ends[1];
  thread_ = std::thread([this] { Watch(); });
}

StopWithInput::~StopWithInput() {
  close(wake_write_);
  thread_.join();
  close(wake_read_);
}

void StopWithInput::Watch() const {
  std::array<char, 256> discarded{};
  while (true) {
    std::array<pollfd, 2> ready{{{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0},
                                 {.fd = wake_read_, .events = POLLIN, .revents = 0}}};
    if (poll(ready.data(), ready.size(), -1) < 0 && errno != EINTR) return RequestStop();
    if (ready[1].revents != 0) return;
    if (ready[0].revents == 0) continue;
    const ssize_t count = read(STDIN_FILENO, discarded.data(), discarded.size());
    if (count == 0 || (count < 0 && errno != EINTR)) return RequestStop();
  }
}

}  // namespace shoal
