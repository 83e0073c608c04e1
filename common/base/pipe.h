// SPDX-License-Identifier: Apache-2.0
// A pipe. The destructor closes both ends. Other programs that the process executes do not inherit
// the ends.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "common/base/descriptor.h"
#include "common/base/error.h"

namespace shoal {

struct Pipe {
  // Throws Error if the system cannot create a pipe.
  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw RuntimeError("pipe: {}", std::strerror(errno));
    read = Descriptor(ends[0]);
    write = Descriptor(ends[1]);
  }

  Descriptor read, write;
};

}  // namespace shoal
