// SPDX-License-Identifier: Apache-2.0
// The events of a simulated run as text, in the order of simulated time, and the promises that were
// broken during the run.
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
  // Records a broken promise; the run has then failed. Called by simulated threads.
  void Violate(const std::string& what) {
    Add("VIOLATION", what);
    violations_.push_back(what);
  }
  const std::vector<std::string>& lines() const { return lines_; }
  const std::vector<std::string>& violations() const { return violations_; }

 private:
  std::vector<std::string> lines_, violations_;
};

}  // namespace shoal::simulation
