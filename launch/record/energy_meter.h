// SPDX-License-Identifier: Apache-2.0
// Energy that the processors of this host have used, from Linux' power capping files (RAPL of Intel
// and AMD): /sys/class/powercap/intel-rapl:N, one folder for each processor package N.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace shoal::launch {

// Sums the energy of all packages, including what other programs used. One thread.
class EnergyMeter {
 public:
  // Begins to count. `powercap`: folder with the packages' folders.
  explicit EnergyMeter(const std::filesystem::path& powercap = "/sys/class/powercap");

  // Adds the energy since the last call. Call it more often than a counter wraps, which takes 20
  // minutes or more. A package whose counter cannot be read any more ends the count: WattHours() is
  // empty from then on.
  void Sample();

  // Energy from the construction to the last Sample(), in Wh. Empty if the counters cannot be read:
  // the host has none (virtual machines), or they are only for root (Linux since 5.10).
  std::optional<double> WattHours() const;

 private:
  struct Package {
    std::filesystem::path counter;  // file of the counter
    uint64_t range = 0;             // largest value of the counter, in microjoules
    uint64_t last = 0;              // value at the last sample, in microjoules
  };

  std::vector<Package> packages_;
  double joules_ = 0;
};

}  // namespace shoal::launch
