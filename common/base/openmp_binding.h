// SPDX-License-Identifier: Apache-2.0
// Makes Shoal's programs ignore the OpenMP variables that bind threads to cores.
//
// Clusters export OMP_PROC_BIND, OMP_PLACES, GOMP_CPU_AFFINITY or KMP_AFFINITY for every program.
// libgomp reads these variables when it is loaded and binds the first thread to one core before
// main. All threads and child processes inherit that mask, so a whole run would share one core.
// Each program therefore removes the variables from its environment before any library is
// initialised, and keeps the affinity mask that it was started with (openmp_binding_start.cpp).
//
// Libraries of Shoal in a user's process (the Python module, libshoal-policy) remove nothing.
#pragma once

#include <string>
#include <vector>

namespace shoal {

// The variables that this program removed when it started, each as "NAME=VALUE".
std::vector<std::string> IgnoredOpenMpBindings();

namespace internal {

// Written before main by openmp_binding_start.cpp; unused entries are null. The strings belong to
// the process's initial environment, which lives as long as the process.
constexpr int kMostBindings = 8;
extern const char* ignored_openmp_bindings[kMostBindings];

}  // namespace internal
}  // namespace shoal
