// SPDX-License-Identifier: Apache-2.0
// A pipe whose ends are closed by their destructors and when the process executes another program.
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
  // Throws Error when the system cannot create a pipe.
  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw RuntimeError("pipe: {}", std::strerror(errno));
    read = Descriptor(ends[0]);
    write = Descriptor(ends[1]);
  }

  Descriptor read, write;
};

}  // namespace shoal
