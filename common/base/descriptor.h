// SPDX-License-Identifier: Apache-2.0
// A file descriptor that closes itself.
#pragma once

#include <unistd.h>

#include <utility>

#include "common/base/scheduler.h"

namespace shoal {

class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {
    if (fd_ < 0) return;
    if (Scheduler* scheduler = Scheduler::Current()) scheduler->OnOpened(fd_);
  }
  ~Descriptor() { Close(); }
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    if (this == &other) return *this;
    Close();
    fd_ = std::exchange(other.fd_, -1);
    return *this;
  }
  int get() const { return fd_; }
  void Close() {
    if (fd_ < 0) return;
    if (Scheduler* scheduler = Scheduler::Current()) scheduler->OnClosed(fd_);
    close(std::exchange(fd_, -1));
  }

 private:
  int fd_ = -1;  // -1: no descriptor
};

}  // namespace shoal
