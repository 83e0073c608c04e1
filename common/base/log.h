// SPDX-License-Identifier: Apache-2.0
// Logging: one line per event to stderr and, when asked, to a file. Thread-safe.
#pragma once

#include <fmt/core.h>

#include <memory>
#include <string>
#include <utility>

namespace shoal::log {

// Call once at start. `name` (role and id, e.g. "actor-3") starts each line; `file` empty = none.
// A file that cannot be opened throws Error.
void Start(const std::string& name, const std::string& file);

// A log of its own for the threads of a group (thread_group.h).
class File;
// Appends to `file` alone. Throws Error where it cannot be opened.
std::shared_ptr<File> OpenFile(const std::string& name, const std::string& file);
// One line as it is, without time and name.
void WriteRaw(File& log, const std::string& line);

// Into the log of the calling thread's group, else into the process's.
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
