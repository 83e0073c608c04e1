// What this machine offers, as meta.json records it.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace shoal::launch {

// {cpu, cores, memory_gb, isa, kernel}: cores that this process may use; isa is what the network
// code found.
nlohmann::ordered_json DescribeMachine();

}  // namespace shoal::launch
