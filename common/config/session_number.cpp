// SPDX-License-Identifier: Apache-2.0
#include "common/config/session_number.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <string_view>

#include "common/base/descriptor.h"
#include "common/base/disk_steps.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/log.h"
#include "common/run_folder/run_file_names.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;

// 0 if there was none.
uint64_t LastSession(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return 0;
  const std::string text = ReadFile(file);
  const char* end = text.data() + text.size();
  uint64_t last = 0;
  const auto [parsed, fault] = std::from_chars(text.data(), end, last);
  if (fault != std::errc() || std::string_view(parsed, end) != "\n") {
    throw UsageError(
        "'{}' does not hold a session number; remove it, and the next number is taken from the "
        "clock",
        file.string());
  }
  return last;
}

// Replaces a text of equal length within the file's own block. This takes no space, so a full disk
// does not prevent it. Returns false on failure.
bool Overwrite(const fs::path& file, const std::string& text) {
  std::error_code none;
  if (fs::file_size(file, none) != text.size() || none) return false;
  const int step = DiskStep(file);
  if (step != 0 && step != ENOSPC) return false;
  const Descriptor out = OpenRegular(file, O_WRONLY);
  const auto size = static_cast<ssize_t>(text.size());
  return pwrite(out.get(), text.data(), text.size(), 0) == size && fsync(out.get()) == 0;
}

void Store(const fs::path& file, const std::string& text) {
  try {
    MakeFolders(file.parent_path());
    WriteFileAtomically(file, text);
  } catch (const Error&) {
    if (!Overwrite(file, text)) throw;
  }
}

}  // namespace

uint64_t NextSession(const fs::path& run, const std::string& process, int64_t wall_time_ns) {
  const fs::path file = run / kSessionFolder / process;
  const auto clock = static_cast<uint64_t>(std::max<int64_t>(1, wall_time_ns));
  const uint64_t session = std::max(clock, LastSession(file) + 1);
  try {
    Store(file, std::to_string(session) + "\n");
  } catch (const Error& e) {
    // The number in the file matters only if the clock is set back before this process has a
    // successor.
    log::Warning("{}; continuing with a number from the clock", e.what());
  }
  return session;
}

}  // namespace shoal
