// SPDX-License-Identifier: Apache-2.0
// Tracks the files that could not be written. Possible reasons: the disk is full or read-only, a
// quota is used up, or a folder was moved. A long-running process continues without these files and
// reports each of them once. The caller decides when to try again.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <utility>

namespace shoal {

// Exit code of a program that completed its work but could not write all its results.
inline constexpr int kUnwrittenExit = 4;

// Only one thread may use an object.
class WriteFaults {
 public:
  // `say` receives a line when the writing of a file begins to fail, and another line when the file
  // is written again. `failing`: files that are already known to fail.
  explicit WriteFaults(std::function<void(const std::string&)> say,
                       std::set<std::string> failing = {})
      : say_(std::move(say)), failing_(std::move(failing)) {}

  // Runs `write`. Returns false if `write` threw Error. `what` names the file, or the kind of file,
  // in the lines and in failing().
  bool Try(const std::string& what, const std::function<void()>& write);

  // The files whose last write failed.
  const std::set<std::string>& failing() const { return failing_; }

 private:
  const std::function<void(const std::string&)> say_;
  std::set<std::string> failing_;
};

}  // namespace shoal
