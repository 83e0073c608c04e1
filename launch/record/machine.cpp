// SPDX-License-Identifier: Apache-2.0
#include "launch/record/machine.h"

#include <fmt/core.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "common/base/usable_cores.h"
#include "common/nn/precision.h"

namespace shoal::launch {
namespace {

// The value of the first line "KEY<tabs>: VALUE"; empty without one. "model" is not "model name".
std::string_view ValueOf(std::string_view key, std::string_view cpuinfo) {
  while (!cpuinfo.empty()) {
    const std::string_view line = cpuinfo.substr(0, cpuinfo.find('\n'));
    cpuinfo.remove_prefix(std::min(cpuinfo.size(), line.size() + 1));
    const size_t colon = line.find(": ");
    if (colon == std::string_view::npos) continue;
    const std::string_view name = line.substr(0, line.find_last_not_of("\t ", colon - 1) + 1);
    if (name == key) return line.substr(colon + 2);
  }
  return {};
}

// Empty if the file does not exist. Reads to the end, because files in /proc report no size.
std::string CpuInfo() {
  std::ifstream in("/proc/cpuinfo");
  return {std::istreambuf_iterator<char>(in), {}};
}

nlohmann::ordered_json LookAtMachine() {
  const double bytes =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  utsname system{};
  uname(&system);
  return {{"cpu", CpuName(CpuInfo())},
          {"cores", UsableCores()},
          {"memory_gb", std::round(bytes / 1e8) / 10},
          {"isa", nn::CpuIsa()},
          {"kernel", system.release}};
}

}  // namespace

std::string CpuName(std::string_view cpuinfo) {
  const std::string_view name = ValueOf("model name", cpuinfo);
  if (name.empty()) return "unknown";
  const std::string_view family = ValueOf("cpu family", cpuinfo), model = ValueOf("model", cpuinfo);
  if (family.empty() || model.empty()) return std::string(name);
  return fmt::format("{} (family {}, model {})", name, family, model);
}

nlohmann::ordered_json DescribeMachine() {
  static const nlohmann::ordered_json machine = LookAtMachine();
  return machine;
}

}  // namespace shoal::launch
