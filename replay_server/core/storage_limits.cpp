// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/storage_limits.h"

#include <linux/magic.h>
#include <sys/resource.h>
#include <sys/statfs.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

#include "common/base/cgroup.h"
#include "common/base/error.h"

namespace shoal::replay {
namespace {

namespace fs = std::filesystem;

// Reads a file with one number. Nothing if the file is missing or contains "max".
std::optional<uint64_t> ReadNumber(const fs::path& path) {
  std::ifstream in(path);
  uint64_t value = 0;
  if (!(in >> value)) return std::nullopt;
  return value;
}

// Reads the number after `key` in a file of "key value" lines.
std::optional<uint64_t> ReadKey(const fs::path& path, const std::string& key) {
  std::ifstream in(path);
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string name;
    uint64_t value = 0;
    if (words >> name >> value && name == key) return value;
  }
  return std::nullopt;
}

struct CgroupFiles {
  const char* limit;
  const char* usage;
  const char* cache;  // key in memory.stat
};
constexpr CgroupFiles kCgroupV2 = {"memory.max", "memory.current", "inactive_file"};
constexpr CgroupFiles kCgroupV1 = {"memory.limit_in_bytes", "memory.usage_in_bytes",
                                   "total_inactive_file"};

// Reduces `room` to what the group leaves.
void ApplyCgroup(const CgroupFolder& group, MemoryRoom* room) {
  const CgroupFiles& files = group.version == 1 ? kCgroupV1 : kCgroupV2;
  const std::optional<uint64_t> limit = ReadNumber(group.path / files.limit);
  if (!limit) return;
  const uint64_t usage = ReadNumber(group.path / files.usage).value_or(0);
  const uint64_t cache = ReadKey(group.path / "memory.stat", files.cache).value_or(0);
  const uint64_t used = usage - std::min(usage, cache);
  const uint64_t left = *limit - std::min(*limit, used);
  if (left < room->bytes) *room = {left, (group.path / files.limit).string()};
}

constexpr double kMegabyte = 1e6;

}  // namespace

MemoryRoom AvailableMemory(const fs::path& root) {
  MemoryRoom room{std::numeric_limits<uint64_t>::max(), "nothing known"};
  if (const auto kilobytes = ReadKey(root / "proc/meminfo", "MemAvailable:")) {
    room = {*kilobytes * 1024, "MemAvailable"};
  }
  for (const CgroupFolder& group : CgroupFolders("memory", root)) ApplyCgroup(group, &room);
  return room;
}

void CheckMemoryRoom(uint64_t bytes, std::string_view remedy, const fs::path& root) {
  const MemoryRoom room = AvailableMemory(root);
  if (bytes <= room.bytes) return;
  throw RuntimeError(
      "the replay needs {:.0f} MB of memory and {:.0f} MB are available ({}): lower "
      "replay.capacity or the frame size, or {}",
      double(bytes) / kMegabyte, double(room.bytes) / kMegabyte, room.source, remedy);
}

void CheckDiskRoom(const fs::path& folder, uint64_t bytes) {
  struct rlimit limit {};
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
      limit.rlim_cur < bytes) {
    throw RuntimeError(
        "the replay file needs {:.0f} MB and files may have {:.0f} MB (ulimit -f): raise the "
        "limit, lower replay.capacity or set replay.storage=memory",
        double(bytes) / kMegabyte, double(limit.rlim_cur) / kMegabyte);
  }
  struct statvfs disk {};
  struct statfs kind {};
  if (statvfs(folder.c_str(), &disk) != 0 || statfs(folder.c_str(), &kind) != 0) {
    throw RuntimeError("cannot ask for the free space of '{}': {}", folder.string(),
                       std::strerror(errno));
  }
  const uint64_t free_bytes = uint64_t{disk.f_bavail} * disk.f_frsize;
  if (free_bytes < bytes) {
    throw RuntimeError(
        "the replay file needs {:.0f} MB and {:.0f} MB are free in '{}': free some, lower "
        "replay.capacity, move run_dir or set replay.storage=memory",
        double(bytes) / kMegabyte, double(free_bytes) / kMegabyte, folder.string());
  }
  if (kind.f_type == TMPFS_MAGIC || kind.f_type == RAMFS_MAGIC) {
    CheckMemoryRoom(bytes, "move run_dir to a disk");
  }
}

}  // namespace shoal::replay
