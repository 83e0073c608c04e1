// SPDX-License-Identifier: Apache-2.0
// The events of a simulated run, in plain words, by simulated time.
#pragma once

#include <fmt/core.h>

#include <string>
#include <vector>

#include "common/base/clock.h"

namespace shoal::simulation {

class Story {
 public:
  // Called by simulated threads.
  void Add(const std::string& who, const std::string& what) {
    const double seconds = std::chrono::duration<double>(Now().time_since_epoch()).count();
    lines_.push_back(fmt::format("{:9.3f} s  {}: {}", seconds, who, what));
  }
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::vector<std::string> lines_;
};

}  // namespace shoal::simulation
