// What this machine offers, as meta.json records it.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace shoal::launch {

// Where the number of usable cores comes from.
struct CoreLimits {
  int online = 0;    // of the machine
  int affinity = 0;  // this process may run on
  double quota = 0;  // CPUs' worth of time that the cgroup grants; infinite without a limit
};
CoreLimits ReadCoreLimits();

// Cores this process may use: its affinity, cut to the cgroup's CPU quota (rounded up). At least 1.
int UsableCores();

// {cpu, cores, memory_gb, isa, kernel}: cores as above; isa is what the network code found.
nlohmann::ordered_json DescribeMachine();

}  // namespace shoal::launch
