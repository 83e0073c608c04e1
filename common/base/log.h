// SPDX-License-Identifier: Apache-2.0
// Logging: one line per event to stderr and optionally to a file. Thread-safe.
#pragma once

#include <fmt/core.h>

#include <memory>
#include <string>
#include <utility>

namespace shoal::log {

// Call once at start. Each line begins with `name` (role and id, e.g. "actor-3"). If `file` is
// empty, no file is written. Throws Error if the file cannot be opened.
void Start(const std::string& name, const std::string& file);

// A log of its own for the threads of a group (thread_group.h).
class File;
// Opens a log that appends to `file` only. Throws Error if the file cannot be opened.
std::shared_ptr<File> OpenFile(const std::string& name, const std::string& file);
// Writes one line unchanged, without time and name.
void WriteRaw(File& log, const std::string& line);

// Write into the log of the calling thread's group or, if the thread has no group, into the
// process's log.
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
