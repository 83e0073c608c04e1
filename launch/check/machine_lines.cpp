// SPDX-License-Identifier: Apache-2.0
#include "launch/check/machine_lines.h"

#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <sstream>
#include <string_view>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/openmp_binding.h"
#include "learner/device/card_loader.h"
#include "replay_server/core/storage_limits.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

double Megabytes(uint64_t bytes) { return static_cast<double>(bytes) / 1e6; }

uint64_t FreeBytes(const fs::path& folder) {
  struct statvfs disk {};
  if (statvfs(folder.c_str(), &disk) != 0) {
    throw RuntimeError("cannot ask for the free space of '{}': {}", folder.string(),
                       std::strerror(errno));
  }
  return uint64_t{disk.f_bavail} * disk.f_frsize;
}

constexpr std::string_view kTriedDebians[] = {"12", "13"};

// The value of NAME=value, NAME="value" or NAME='value' in the text of an os-release file; empty
// where the name is absent.
std::string ValueOf(std::string_view name, const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(fmt::format("{}=", name))) continue;
    std::string value = line.substr(name.size() + 1);
    if (value.size() >= 2 && value.front() == value.back() &&
        (value.front() == '"' || value.front() == '\'')) {
      value = value.substr(1, value.size() - 2);
    }
    return value;
  }
  return "";
}

}  // namespace

CheckLine JudgeCpu(const std::string& isa, const std::string& precision) {
  CheckLine line{"cpu", Verdict::kOk, fmt::format("{}, precision {}", isa, precision), ""};
  const bool wide = isa.starts_with("avx2") || isa.starts_with("avx512");
  if (!wide) {
    line.verdict = Verdict::kWarn;
    line.advice =
        "no AVX2: updates take several times as long; use a newer machine or a virtual "
        "machine that passes the CPU's features on";
  }
  return line;
}

CheckLine JudgeCores(const CoreLimits& limits) {
  const int usable = UsableCores(limits);
  const std::string quota = std::isinf(limits.quota)
                                ? "no cgroup quota"
                                : fmt::format("cgroup quota {:.2g}", limits.quota);
  CheckLine line{"cores", Verdict::kOk,
                 fmt::format("{} usable of {} online (affinity {}, {})", usable, limits.online,
                             limits.affinity, quota),
                 ""};
  for (const std::string& binding : IgnoredOpenMpBindings()) {
    line.finding += fmt::format("; {} is ignored", binding);
  }
  if (usable < 2) {
    line.verdict = Verdict::kWarn;
    const std::string why = DescribeLimits(limits);
    line.advice = fmt::format(
        "learner and actors share one core and take turns{}; give the process two or more",
        why.empty() ? "" : ": " + why);
  }
  return line;
}

CheckLine LookAtGpu() {
  CheckLine line{"gpu", Verdict::kOk, "", ""};
  try {
    const learner::CardInfo gpu = learner::ProbeCard();
    line.finding = fmt::format("{} ({:.0f} GB, driver {}), for learner.device=cuda", gpu.name,
                               static_cast<double>(gpu.memory_bytes) / 1e9, gpu.driver);
  } catch (const Error& e) {
    line.finding = fmt::format("none is used: {}", e.what());
  }
  return line;
}

CheckLine JudgeSystem(const std::vector<fs::path>& release_files) {
  const auto file = std::ranges::find_if(
      release_files, [](const fs::path& path) { return access(path.c_str(), R_OK) == 0; });
  if (file == release_files.end()) {
    return {"system", Verdict::kOk,
            "unknown: there is no os-release file (tested: Debian 12 and 13)", ""};
  }
  const std::string text = ReadFile(*file);
  const std::string name = ValueOf("PRETTY_NAME", text);
  const bool tried =
      ValueOf("ID", text) == "debian" &&
      std::ranges::find(kTriedDebians, ValueOf("VERSION_ID", text)) != std::end(kTriedDebians);
  return {"system", Verdict::kOk,
          fmt::format("{}; {}", name.empty() ? "unnamed in " + file->string() : name,
                      tried ? "tested" : "not tested (tested: Debian 12 and 13)"),
          ""};
}

fs::path ExistingFolder(const fs::path& path) {
  fs::path folder = fs::absolute(path).lexically_normal();
  std::error_code error;
  while (!fs::is_directory(folder, error) && folder.has_relative_path()) {
    folder = folder.parent_path();
  }
  return folder;
}

CheckLine LookAtDisk(const fs::path& run_dir, const Needs& needs) {
  const fs::path folder = ExistingFolder(run_dir);
  if (access(folder.c_str(), W_OK) != 0) {
    throw RuntimeError("cannot write to '{}': {}", folder.string(), std::strerror(errno));
  }
  replay::CheckDiskRoom(folder, needs.ring_bytes);
  return {"disk", Verdict::kOk,
          fmt::format("{:.0f} MB free in '{}', the default preset's replay takes {:.0f} MB",
                      Megabytes(FreeBytes(folder)), folder.string(), Megabytes(needs.ring_bytes)),
          ""};
}

CheckLine JudgeMemory(uint64_t available, const std::string& source, const Needs& needs) {
  const uint64_t comfortable = needs.process_bytes + needs.ring_bytes;
  CheckLine line{"memory", Verdict::kOk,
                 fmt::format("{:.0f} MB available ({}); the default preset's processes take {:.0f} "
                             "MB, its replay's pages {:.0f} MB",
                             Megabytes(available), source, Megabytes(needs.process_bytes),
                             Megabytes(needs.ring_bytes)),
                 ""};
  if (available < needs.process_bytes) {
    line.verdict = Verdict::kFail;
    line.advice = "free memory or raise the container's limit";
  } else if (available < comfortable) {
    line.verdict = Verdict::kWarn;
    line.advice =
        "sampling reads from the disk once the replay has outgrown the memory; lower "
        "replay.capacity";
  }
  return line;
}

CheckLine LookAtSharedMemory(const fs::path& folder) {
  const std::string room =
      fs::is_directory(folder)
          ? fmt::format("{:.0f} MB free in '{}'", Megabytes(FreeBytes(folder)), folder.string())
          : fmt::format("no '{}'", folder.string());
  return {"shared memory", Verdict::kOk,
          room + "; none is needed, batches go through memory without a file", ""};
}

}  // namespace shoal::launch
