// SPDX-License-Identifier: Apache-2.0
// The only exception type. Shoal throws an Error only for failures with a cause outside the
// program: files, configuration, DDS, child processes, malformed messages. The main function of
// each process catches the Error (main_guard.h), prints one line on stderr and returns the exit
// code.
//
// A bug fails a CHECK (check.h). If a missing value is normal, functions return std::optional or an
// enum. Code that handles records and batches does not throw.
#pragma once

#include <fmt/core.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace shoal {

// Exit codes of every program: 0 success, 1 run-time failure, 2 wrong usage (arguments,
// configuration), 3 a number that is not finite (simulation, weights, losses), 5 a GPU that failed
// or was lost. If a command ended with 2 or 3, the same command would fail again. 4 is
// kUnwrittenExit (write_faults.h).
enum class ErrorKind { kRuntime = 1, kUsage = 2, kNonFinite = 3, kDevice = 5 };

class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  int exit_code() const { return static_cast<int>(kind_); }

 private:
  ErrorKind kind_;
};

// The message is one line: what failed, with which value, what was expected.
template <class... Args>
Error RuntimeError(fmt::format_string<Args...> format, Args&&... args) {
  return Error(ErrorKind::kRuntime, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
Error UsageError(fmt::format_string<Args...> format, Args&&... args) {
  return Error(ErrorKind::kUsage, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
Error NonFiniteError(fmt::format_string<Args...> format, Args&&... args) {
  return Error(ErrorKind::kNonFinite, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
Error DeviceError(fmt::format_string<Args...> format, Args&&... args) {
  return Error(ErrorKind::kDevice, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace shoal
