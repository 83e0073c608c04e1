// SPDX-License-Identifier: Apache-2.0
// Limits the log lines of one kind, so that a foreign sender cannot fill the disk. In each time
// span kSpan, only the first kLines lines are logged. The first line after a gap reports the number
// of lines that were left out.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "common/base/clock.h"

namespace shoal {

// Not thread-safe; use it from one owner or under a lock.
class LineBudget {
 public:
  static constexpr int kLines = 20;
  static constexpr std::chrono::seconds kSpan{60};

  // Asks to log one more line. Returns the number of lines left out before this one, or empty if
  // this line must be left out too.
  std::optional<uint64_t> Take(SteadyTime now) {
    if (!begin_ || now - *begin_ >= kSpan) {
      begin_ = now;
      lines_ = 0;
    }
    if (lines_ == kLines) {
      ++left_out_;
      return std::nullopt;
    }
    ++lines_;
    const uint64_t before = left_out_;
    left_out_ = 0;
    return before;
  }

 private:
  std::optional<SteadyTime> begin_;
  int lines_ = 0;
  uint64_t left_out_ = 0;
};

}  // namespace shoal
