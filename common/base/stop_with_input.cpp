// SPDX-License-Identifier: Apache-2.0
#include "common/base/stop_with_input.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "common/base/stop.h"

namespace shoal {

StopWithInput::StopWithInput() : thread_([this] { Watch(); }) {}

StopWithInput::~StopWithInput() {
  wake_.write.Close();
  thread_.join();
}

void StopWithInput::Watch() const {
  std::array<char, 256> discarded{};
  while (true) {
    std::array<pollfd, 2> ready{{{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0},
                                 {.fd = wake_.read.get(), .events = POLLIN, .revents = 0}}};
    if (poll(ready.data(), ready.size(), -1) < 0 && errno != EINTR) return RequestStop();
    if (ready[1].revents != 0) return;
    if (ready[0].revents == 0) continue;
    const ssize_t count = read(STDIN_FILENO, discarded.data(), discarded.size());
    if (count == 0 || (count < 0 && errno != EINTR)) return RequestStop();
  }
}

}  // namespace shoal
