// SPDX-License-Identifier: Apache-2.0
// Thrown when a stop signal (stop.h) ends a task before the task has a result. GuardMain prints one
// line, and the process ends by this signal.
#pragma once

#include "common/base/error.h"

namespace shoal {

class Interrupted : public Error {
 public:
  // `message` says what is missing: "before the run's coordinator answered".
  explicit Interrupted(const std::string& message) : Error(ErrorKind::kRuntime, message) {}
};

}  // namespace shoal
