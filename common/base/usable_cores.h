// SPDX-License-Identifier: Apache-2.0
// How many cores this process may use.
#pragma once

#include <filesystem>

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

}  // namespace shoal
