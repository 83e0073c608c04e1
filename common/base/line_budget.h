// SPDX-License-Identifier: Apache-2.0
// Limits the lines of a kind that a log takes, so that a sender outside cannot fill a disk: the
// first kLines of each kSpan. The next line reports the number of lines that were left out.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "common/base/clock.h"

namespace shoal {

// Threads: none inside; one owner, or a lock.
class LineBudget {
 public:
  static constexpr int kLines = 20;
  static constexpr std::chrono::seconds kSpan{60};

  // For one more line: how many were left out before it, or nothing when it is to be left out, too.
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
