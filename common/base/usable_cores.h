// SPDX-License-Identifier: Apache-2.0
// Number of cores that this process may use.
#pragma once

#include <filesystem>
#include <string>

namespace shoal {

struct CoreLimits {
  int online = 0;    // online cores of the machine
  int affinity = 0;  // cores in the affinity mask of this process
  double quota = 0;  // processor time that the cgroups grant, in CPUs; infinite without a limit
};

// Reads the cgroups below `root`, which is "/" except in tests.
CoreLimits ReadCoreLimits(const std::filesystem::path& root = "/");

// The smaller of the affinity and the quota (rounded up). At least 1.
int UsableCores(const CoreLimits& limits);
int UsableCores();

// Why the process may not use all online cores, or "" if it may: "1 of 8 by its CPU affinity mask
// (set by taskset, a scheduler or the program that started it)". Also names OpenMP variables that
// this program ignores, because they may have bound the program that started it.
std::string DescribeLimits(const CoreLimits& limits);

}  // namespace shoal
