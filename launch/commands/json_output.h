// SPDX-License-Identifier: Apache-2.0
// Destination of --json FILE: the file, or standard output for "-". With "-" the
// command prints its text on standard error.
#pragma once

#include <cstdio>
#include <string>

namespace shoal::launch {

class JsonOutput {
 public:
  // For whom the file is: the run's user alone, or others as the umask says (common/base/files.h).
  enum class Readers { kUser, kOthers };

  // `file` is empty where no JSON is asked for. Throws Error when it could not be written.
  explicit JsonOutput(std::string file, Readers readers = Readers::kUser);

  // Stream for the command's text.
  std::FILE* text() const { return OnStdout() ? stderr : stdout; }
  // Writes the file now, which Write replaces later; nothing on standard output.
  void WriteEarly(const std::string& json) const;
  void Write(const std::string& json) const;

 private:
  bool OnStdout() const { return file_ == "-"; }

  const std::string file_;
  const Readers readers_;
};

}  // namespace shoal::launch
