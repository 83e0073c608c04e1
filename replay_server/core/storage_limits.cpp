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

#include "common/base/error.h"

namespace shoal::replay {
namespace {

namespace fs = std::filesystem;

// A file holding one number; nothing when it is missing or says "max".
std::optional<uint64_t> ReadNumber(const fs::path& path) {
  std::ifstream in(path);
  uint64_t value = 0;
  if (!(in >> value)) return std::nullopt;
  return value;
}

// The number after `key` in a file of "key value" lines.
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
  const char* mount;  // below root
  const char* limit;
  const char* usage;
  const char* cache;  // key in memory.stat
};
constexpr CgroupFiles kCgroupV2 = {"sys/fs/cgroup", "memory.max", "memory.current",
                                   "inactive_file"};
constexpr CgroupFiles kCgroupV1 = {"sys/fs/cgroup/memory", "memory.limit_in_bytes",
                                   "memory.usage_in_bytes", "total_inactive_file"};

// Lowers `room` by the cgroup at `group` and those around it.
void ApplyCgroups(const fs::path& root, const CgroupFiles& files, fs::path group,
                  MemoryRoom* room) {
  for (;; group = group.parent_path()) {
    const fs::path folder = root / files.mount / group.relative_path();
    const std::optional<uint64_t> limit = ReadNumber(folder / files.limit);
    if (limit) {
      const uint64_t usage = ReadNumber(folder / files.usage).value_or(0);
      const uint64_t cache = ReadKey(folder / "memory.stat", files.cache).value_or(0);
      const uint64_t used = usage - std::min(usage, cache);
      const uint64_t left = *limit - std::min(*limit, used);
      if (left < room->bytes) *room = {left, (folder / files.limit).string()};
    }
    if (!group.has_relative_path()) return;
  }
}

constexpr double kMegabyte = 1e6;

}  // namespace

MemoryRoom AvailableMemory(const fs::path& root) {
  MemoryRoom room{std::numeric_limits<uint64_t>::max(), "nothing known"};
  if (const auto kilobytes = ReadKey(root / "proc/meminfo", "MemAvailable:")) {
    room = {*kilobytes * 1024, "MemAvailable"};
  }
  std::ifstream groups(root / "proc/self/cgroup");
  std::string line;  // "HIERARCHY:CONTROLLERS:PATH"; version 2 has no controllers
  while (std::getline(groups, line)) {
    const size_t first = line.find(':');
    const size_t second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = fmt::format(",{},", line.substr(first + 1, second - first - 1));
    const std::string group = line.substr(second + 1);
    if (controllers == ",,") ApplyCgroups(root, kCgroupV2, group, &room);
    if (controllers.find(",memory,") != std::string::npos) {
      ApplyCgroups(root, kCgroupV1, group, &room);
    }
  }
  return room;
}

void CheckMemoryRoom(uint64_t bytes) {
  const MemoryRoom room = AvailableMemory();
  if (bytes <= room.bytes) return;
  throw RuntimeError(
      "the replay needs {:.0f} MB of memory and {:.0f} MB are available ({}): lower "
      "replay.capacity "
      "or the frame size, or set replay.storage=file",
      double(bytes) / kMegabyte, double(room.bytes) / kMegabyte, room.source);
}

void CheckDiskRoom(const fs::path& folder, uint64_t bytes) {
  struct rlimit limit {};
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
      limit.rlim_cur < bytes) {
    throw RuntimeError(
        "the replay file needs {:.0f} MB and files may have {:.0f} MB (ulimit -f): raise the "
        "limit, "
        "lower replay.capacity or set replay.storage=memory",
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
  if (kind.f_type == TMPFS_MAGIC || kind.f_type == RAMFS_MAGIC) CheckMemoryRoom(bytes);
}

}  // namespace shoal::replay
