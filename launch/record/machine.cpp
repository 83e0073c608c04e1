#include "launch/record/machine.h"

#include <sys/utsname.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "common/base/usable_cores.h"
#include "common/nn/precision.h"

namespace shoal::launch {
namespace {

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
