// SPDX-License-Identifier: Apache-2.0
// Processes of one measurement, forked from one that has no threads yet: pipes between them, the
// DDS domain where they meet, and the run that they play.
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

// Values of one kind from process to process, each whole, also with several writers. Throws Error
// when the other side has ended.
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
  // Waits for as long as it takes.
  T Read() const {
    T value{};
    if (read(in_.get(), &value, sizeof value) != static_cast<ssize_t>(sizeof value)) {
      throw RuntimeError("a process of the measurement has ended");
    }
    return value;
  }
  // Throws Error also when nothing comes within that time.
  T Read(std::chrono::milliseconds deadline) const {
    pollfd in{.fd = in_.get(), .events = POLLIN, .revents = 0};
    if (poll(&in, 1, static_cast<int>(deadline.count())) <= 0) {
      throw RuntimeError("a process of the measurement said nothing for {} ms", deadline.count());
    }
    return Read();
  }
  // Only the other processes write: their end is then the reader's.
  void CloseWriter() { out_.Close(); }

 private:
  Descriptor in_, out_;
};

// Runs `body` in a process of its own, which dies with this one; its errors go to stderr after
// `name`.
pid_t Fork(const char* name, const std::function<void()>& body);

// The place of a run on DDS, as it goes through a pipe.
struct Meeting {
  int domain = 0;
  char tag[64] = {};
};
// A domain that is free, for processes of the measurement alone.
Meeting FreeMeeting(const TransportConfig& transport);
ClusterAddress AddressOf(const Meeting& meeting);

// Observations of two RGB cameras, 84x84, one frame; actions of four numbers.
RunConfig TwoCameraRun(const std::string& name);

}  // namespace shoal::bench
