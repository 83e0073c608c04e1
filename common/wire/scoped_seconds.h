// SPDX-License-Identifier: Apache-2.0
// Adds the duration of its scope, in seconds, to a total.
#pragma once

#include "common/base/clock.h"

namespace shoal {

// Borrows the total; only one thread may write the total.
class ScopedSeconds {
 public:
  explicit ScopedSeconds(double& total) : total_(total), start_(Now()) {}
  ~ScopedSeconds() { total_ += SecondsSince(start_); }
  ScopedSeconds(const ScopedSeconds&) = delete;
  ScopedSeconds& operator=(const ScopedSeconds&) = delete;

 private:
  double& total_;
  const SteadyTime start_;
};

}  // namespace shoal
