// SPDX-License-Identifier: Apache-2.0
// Isolates the test's process and its children: mounts, network, memory limit. Each function
// returns "", or the reason why isolation is impossible on this machine, for GTEST_SKIP. Each test
// must run in a separate process, as with ctest.
#pragma once

#include <fcntl.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

namespace shoal {

inline std::string Because(const std::string& what) { return what + ": " + std::strerror(errno); }

// Calls unshare(what). If the user is not root, the process becomes root in a new user namespace.
inline std::string Unshare(int what) {
  const uid_t uid = geteuid();
  if (unshare(uid == 0 ? what : what | CLONE_NEWUSER) != 0) return Because("unshare");
  if (uid != 0) std::ofstream("/proc/self/uid_map") << "0 " << uid << " 1";
  return "";
}

inline std::string OwnMounts() {
  if (const std::string no = Unshare(CLONE_NEWNS); !no.empty()) return no;
  if (mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return Because("mount /");
  return "";
}

// Mounts a disk of this size in memory over the folder, until destruction. Call OwnMounts() before.
class SmallDisk {
 public:
  SmallDisk(const std::filesystem::path& folder, const std::string& size, unsigned long flags = 0)
      : folder_(folder) {
    const std::string options = "size=" + size;
    if (mount("tmpfs", folder.c_str(), "tmpfs", flags, options.c_str()) != 0) {
      why_not_ = Because("mount");
    }
  }
  ~SmallDisk() {
    if (why_not_.empty()) umount2(folder_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  const std::string& why_not() const { return why_not_; }

 private:
  const std::filesystem::path folder_;
  std::string why_not_;
};

// Moves the process to a new network that has only a loopback interface.
inline std::string OwnNetwork() {
  if (const std::string no = Unshare(CLONE_NEWNET); !no.empty()) return no;
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  request.ifr_flags = IFF_UP | IFF_RUNNING;
  const bool up = fd >= 0 && ioctl(fd, SIOCSIFFLAGS, &request) == 0;
  const std::string no = up ? "" : Because("loopback");
  close(fd);
  return no;
}

// A control group that limits the memory of this process and its children until destruction.
class MemoryLimit {
 public:
  explicit MemoryLimit(uint64_t bytes) {
    for (const auto& [group, limit] :
         {std::pair(OwnGroup(":memory:", "/sys/fs/cgroup/memory"), "memory.limit_in_bytes"),
          std::pair(OwnGroup("0::", "/sys/fs/cgroup"), "memory.max")}) {
      if (!std::filesystem::exists(group / limit)) continue;
      home_ = group;
      group_ = group / ("shoal-test-" + std::to_string(getpid()));
      std::error_code error;
      if (!std::filesystem::create_directory(group_, error)) break;
      if (Write(group_ / limit, bytes) && Write(group_ / "cgroup.procs", uint64_t(getpid()))) {
        return;
      }
      break;
    }
    why_not_ = Because("no writable memory control group");
  }
  ~MemoryLimit() {
    if (home_.empty()) return;
    Write(home_ / "cgroup.procs", uint64_t(getpid()));
    rmdir(group_.c_str());
  }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

  const std::string& why_not() const { return why_not_; }
  const std::filesystem::path& group() const { return group_; }

 private:
  // This process's group in the hierarchy whose line of /proc/self/cgroup contains `key`.
  static std::filesystem::path OwnGroup(const std::string& key, const std::string& mount) {
    std::ifstream in("/proc/self/cgroup");
    for (std::string line; std::getline(in, line);) {
      const size_t at = line.find(key);
      if (at != std::string::npos) return mount + line.substr(at + key.size());
    }
    return mount;
  }
  static bool Write(const std::filesystem::path& file, uint64_t value) {
    std::ofstream out(file);
    return bool(out << value << std::flush);
  }

  std::filesystem::path home_, group_;
  std::string why_not_;
};

}  // namespace shoal
