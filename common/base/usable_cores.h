// SPDX-License-Identifier: Apache-2.0
// How many cores this process may use.
#pragma once

#include <filesystem>
#include <string>

namespace shoal {

struct CoreLimits {
  int online = 0;    // of the machine
  int affinity = 0;  // this process may run on
  double quota = 0;  // CPUs' worth of time that the cgroups grant; infinite without a limit
};

// Reads the cgroups below `root` ("/" but for tests).
CoreLimits ReadCoreLimits(const std::filesystem::path& root = "/");

// The affinity, cut to the quota (rounded up). At least 1.
int UsableCores(const CoreLimits& limits);
int UsableCores();

// Why the process may not use all online cores, or "" if it may: "1 of 8 by its CPU affinity mask
// (set by taskset, a scheduler or the program that started it)". Names OpenMP variables that this
// program ignores but by which the program that started it may have been bound.
std::string DescribeLimits(const CoreLimits& limits);

}  // namespace shoal
