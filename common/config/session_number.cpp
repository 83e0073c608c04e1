// SPDX-License-Identifier: Apache-2.0
#include "common/config/session_number.h"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/log.h"
#include "common/run_folder/run_file_names.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;

// 0 when there was none.
uint64_t LastSession(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return 0;
  const std::string text = ReadFile(file);
  const char* end = text.data() + text.size();
  uint64_t last = 0;
  const auto [parsed, fault] = std::from_chars(text.data(), end, last);
  if (fault != std::errc() || std::string_view(parsed, end) != "\n") {
    throw UsageError("'{}' does not hold a session number; remove it to begin with the clock's",
                     file.string());
  }
  return last;
}

}  // namespace

uint64_t NextSession(const fs::path& run, const std::string& process, int64_t wall_time_ns) {
  const fs::path file = run / kSessionFolder / process;
  const auto clock = static_cast<uint64_t>(std::max<int64_t>(1, wall_time_ns));
  const uint64_t session = std::max(clock, LastSession(file) + 1);
  try {
    MakeFolders(file.parent_path());
    WriteFileAtomically(file, std::to_string(session) + "\n");
  } catch (const Error& e) {
    // Missed only where the clock is set back before this process has a successor.
    log::Warning("{}; going on with the clock's number", e.what());
  }
  return session;
}

}  // namespace shoal
