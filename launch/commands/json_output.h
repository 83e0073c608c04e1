// SPDX-License-Identifier: Apache-2.0
// Destination of --json FILE: the file, or standard output for "-". With "-" the command prints its
// text on standard error.
#pragma once

#include <cstdio>
#include <string>

namespace shoal::launch {

class JsonOutput {
 public:
  // Users who may read the file: only this user, or others as the umask permits
  // (common/base/files.h).
  enum class Readers { kUser, kOthers };

  // `file` is empty if no JSON is requested. Throws Error if the file cannot be written.
  explicit JsonOutput(std::string file, Readers readers = Readers::kUser);

  // Stream for the command's text.
  std::FILE* text() const { return OnStdout() ? stderr : stdout; }
  // Writes a first version of the file, which Write replaces later. Writes nothing to standard
  // output.
  void WriteEarly(const std::string& json) const;
  void Write(const std::string& json) const;

 private:
  bool OnStdout() const { return file_ == "-"; }

  const std::string file_;
  const Readers readers_;
};

}  // namespace shoal::launch
