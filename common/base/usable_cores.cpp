// SPDX-License-Identifier: Apache-2.0
#include "common/base/usable_cores.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "common/base/cgroup.h"
#include "common/base/openmp_binding.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

int AffinityCores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
  return static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
}

// Reads one number. Negative if the file is missing or says "max".
double ReadNumber(std::istream& in) {
  double number = -1;
  return in >> number ? number : -1;
}

// Microseconds of CPU time per microsecond that one group grants. Version 2 writes "QUOTA PERIOD"
// or "max PERIOD" to one file, version 1 uses two and -1 for no limit.
double QuotaOf(const CgroupFolder& group) {
  double quota = -1, period = -1;
  if (group.version == 2) {
    std::ifstream in(group.path / "cpu.max");
    quota = ReadNumber(in);
    period = ReadNumber(in);
  } else {
    std::ifstream of_quota(group.path / "cpu.cfs_quota_us");
    std::ifstream of_period(group.path / "cpu.cfs_period_us");
    quota = ReadNumber(of_quota);
    period = ReadNumber(of_period);
  }
  return quota > 0 && period > 0 ? quota / period : kNoLimit;
}

}  // namespace

CoreLimits ReadCoreLimits(const fs::path& root) {
  double quota = kNoLimit;
  for (const CgroupFolder& group : CgroupFolders("cpu", root)) {
    quota = std::min(quota, QuotaOf(group));
  }
  return {.online = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)),
          .affinity = AffinityCores(),
          .quota = quota};
}

int UsableCores(const CoreLimits& limits) {
  return std::max(1, static_cast<int>(std::min<double>(limits.affinity, std::ceil(limits.quota))));
}

int UsableCores() { return UsableCores(ReadCoreLimits()); }

std::string DescribeLimits(const CoreLimits& limits) {
  std::string text;
  if (limits.affinity < limits.online) {
    text = fmt::format("{} of {} by its CPU affinity mask", limits.affinity, limits.online);
    const std::vector<std::string> bindings = IgnoredOpenMpBindings();
    text += bindings.empty()
                ? " (set by taskset, a scheduler or the program that started it)"
                : fmt::format(
                      " (set by taskset, a scheduler or the program that started it, which {} may "
                      "have bound)",
                      fmt::join(bindings, " "));
  }
  if (std::ceil(limits.quota) < std::min(limits.affinity, limits.online)) {
    text +=
        fmt::format("{}{:.4g} by its cgroup's CPU quota", text.empty() ? "" : ", ", limits.quota);
  }
  return text;
}

}  // namespace shoal
