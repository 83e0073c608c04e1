#include "launch/machine.h"

#include <sched.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "common/nn/precision.h"

namespace shoal::launch {
namespace {

int AffinityCores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
  return static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
}

// Cores of the cgroup's quota; infinity without one. cgroup v2 writes "QUOTA PERIOD" or "max
// PERIOD".
double QuotaCores() {
  std::ifstream in("/sys/fs/cgroup/cpu.max");
  std::string quota;
  double period = 0;
  if (!(in >> quota >> period) || quota == "max" || period <= 0) return INFINITY;
  std::istringstream number(quota);
  double microseconds = 0;
  return number >> microseconds && microseconds > 0 ? microseconds / period : INFINITY;
}

std::string CpuName() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "unknown";
}

}  // namespace

CoreLimits ReadCoreLimits() {
  return {.online = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)),
          .affinity = AffinityCores(),
          .quota = QuotaCores()};
}

int UsableCores() {
  const CoreLimits limits = ReadCoreLimits();
  const double cores = std::min<double>(limits.affinity, std::ceil(limits.quota));
  return std::max(1, static_cast<int>(cores));
}

nlohmann::ordered_json DescribeMachine() {
  const double bytes =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  utsname system{};
  uname(&system);
  return {{"cpu", CpuName()},
          {"cores", UsableCores()},
          {"memory_gb", std::round(bytes / 1e8) / 10},
          {"isa", nn::CpuIsa()},
          {"kernel", system.release}};
}

}  // namespace shoal::launch
