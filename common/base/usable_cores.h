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

// The smaller of affinity and quota (rounded up). At least 1.
int UsableCores(const CoreLimits& limits);
// The same for the limits of this process.
int UsableCores();

// Why the process may not use all online cores; "" if the process may use all of them. Example: "1
// of 8 by its CPU affinity mask (set by taskset, a scheduler or the program that started it)". The
// text also names the OpenMP variables that this program ignores, because these variables may have
// bound the parent process to cores.
std::string DescribeLimits(const CoreLimits& limits);

}  // namespace shoal
