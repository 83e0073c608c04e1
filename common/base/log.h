// SPDX-License-Identifier: Apache-2.0
// Logging: one line for each event, to stderr and optionally to a file. Thread-safe.
#pragma once

#include <fmt/core.h>

#include <memory>
#include <string>
#include <utility>

namespace shoal::log {

// Starts the log of the process. Call this function once, at the start of the process. Each line
// begins with `name` (role and id, e.g. "actor-3"). If `file` is empty, no file is written. Throws
// Error if the file cannot be opened.
void Start(const std::string& name, const std::string& file);

// Separate log for the threads of a group (thread_group.h).
class File;
// Opens a log that appends to `file` only. Throws Error if the file cannot be opened.
std::shared_ptr<File> OpenFile(const std::string& name, const std::string& file);
// Writes one line unchanged, without time and name.
void WriteRaw(File& log, const std::string& line);

// These functions write one line to the log of the calling thread's group or, if the thread has no
// group, to the log of the process.
void WriteInfo(const std::string& line);
void WriteWarning(const std::string& line);
void WriteError(const std::string& line);

template <class... Args>
void Info(fmt::format_string<Args...> format, Args&&... args) {
  WriteInfo(fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void Warning(fmt::format_string<Args...> format, Args&&... args) {
  WriteWarning(fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void Failure(fmt::format_string<Args...> format, Args&&... args) {
  WriteError(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace shoal::log
