// SPDX-License-Identifier: Apache-2.0
#include "launch/record/run_size.h"

#include <fmt/core.h>
#include <sys/stat.h>

#include <set>

#include "common/run_folder/run_file_names.h"

namespace shoal::launch {
namespace {

constexpr uint64_t kBlock = 512;  // unit of st_blocks on every file system

}  // namespace

RunSize SizeOfRun(const std::filesystem::path& run) {
  RunSize size;
  std::set<ino_t> seen;
  std::error_code error;
  for (std::filesystem::recursive_directory_iterator it(run, error), end; !error && it != end;
       it.increment(error)) {
    struct stat status {};
    if (lstat(it->path().c_str(), &status) != 0 || !seen.insert(status.st_ino).second) continue;
    const uint64_t bytes = static_cast<uint64_t>(status.st_blocks) * kBlock;
    size.total += bytes;
    if (it.depth() == 0 && it->path().filename() == kRingFile) size.replay = bytes;
  }
  return size;
}

std::string FormatBytes(uint64_t bytes) {
  const double megabytes = static_cast<double>(bytes) / 1e6;
  if (megabytes >= 1000) return fmt::format("{:.1f} GB", megabytes / 1000);
  return fmt::format("{:.{}f} MB", megabytes, megabytes < 9.95 ? 1 : 0);
}

}  // namespace shoal::launch
