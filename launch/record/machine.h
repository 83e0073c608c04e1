// SPDX-License-Identifier: Apache-2.0
// Properties of this machine for meta.json.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace shoal::launch {

// {cpu, cores, memory_gb, isa, kernel}. cores: number of cores that this process may use; isa:
// instruction set that the network code uses.
nlohmann::ordered_json DescribeMachine();

// Name of the first processor in the text of /proc/cpuinfo: "NAME (family F, model M)". The numbers
// are needed because virtual machines give different CPUs the same name. If a number is missing,
// the result is "NAME"; if the name is missing, "unknown".
std::string CpuName(std::string_view cpuinfo);

}  // namespace shoal::launch
