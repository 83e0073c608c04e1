// SPDX-License-Identifier: Apache-2.0
// Properties of this machine for meta.json.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace shoal::launch {

// {cpu, cores, memory_gb, isa, kernel}: cores: number that this process may use; isa: instruction
// set that the network code uses.
nlohmann::ordered_json DescribeMachine();

// Name of the first processor in the text of /proc/cpuinfo: "NAME (family F, model M)", because
// virtual machines give different CPUs one name. Without the brackets if either number is missing;
// "unknown" without a name.
std::string CpuName(std::string_view cpuinfo);

}  // namespace shoal::launch
