// SPDX-License-Identifier: Apache-2.0
// Processes of one measurement, forked from a process that has no threads yet: pipes between the
// processes, their DDS domain, and the configuration of their run.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <sys/types.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <functional>
#include <type_traits>

#include "common/base/descriptor.h"
#include "common/base/error.h"
#include "common/config/run_files.h"

namespace shoal::bench {

// Pipe for values of type T between processes. Writes are atomic, also with several writers. The
// functions throw Error if the other side has ended.
template <class T>
class Pipe {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= 512);

 public:
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw RuntimeError("pipe: {}", std::strerror(errno));
    in_ = Descriptor(ends[0]);
    out_ = Descriptor(ends[1]);
  }
  void Write(const T& value) const {
    if (write(out_.get(), &value, sizeof value) != static_cast<ssize_t>(sizeof value)) {
      throw RuntimeError("a process of the measurement has ended");
    }
  }
  // Waits without a deadline.
  T Read() const {
    T value{};
    if (read(in_.get(), &value, sizeof value) != static_cast<ssize_t>(sizeof value)) {
      throw RuntimeError("a process of the measurement has ended");
    }
    return value;
  }
  // Throws Error also if no value is received before the deadline.
  T Read(std::chrono::milliseconds deadline) const {
    pollfd in{.fd = in_.get(), .events = POLLIN, .revents = 0};
    if (poll(&in, 1, static_cast<int>(deadline.count())) <= 0) {
      throw RuntimeError("a process of the measurement said nothing for {} ms", deadline.count());
    }
    return Read();
  }
  // Call it in a process that only reads. The pipe then ends when all other processes have ended.
  void CloseWriter() { out_.Close(); }

 private:
  Descriptor in_, out_;
};

// Runs `body` in a new process that dies with this process. Errors of `body` are written to stderr,
// prefixed with `name`.
pid_t Fork(const char* name, const std::function<void()>& body);

// The DDS address of a run, in a form that can be sent through a pipe.
struct Meeting {
  int domain = 0;
  char tag[64] = {};
};
// Finds a free domain for the processes of the measurement.
Meeting FreeMeeting(const TransportConfig& transport);
ClusterAddress AddressOf(const Meeting& meeting);

// A run with observations of two RGB cameras, 84x84, one frame, and actions of four numbers.
RunConfig TwoCameraRun(const std::string& name);

}  // namespace shoal::bench
