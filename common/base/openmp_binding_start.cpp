// SPDX-License-Identifier: Apache-2.0
// Removes the variables of openmp_binding.h from a program's environment. Every program links this
// file (shoal_program in common/cmake/targets.cmake); libraries cannot contain it.
//
// The dynamic linker calls the functions in .preinit_array before it initialises any library, so
// libgomp never reads these variables. The C library is not initialised yet either, and neither are
// sanitizers: the code below calls nothing, allocates nothing and is compiled without sanitizers.
#include "common/base/openmp_binding.h"

namespace {

// Suffixes such as OMP_PROC_BIND_ALL exist too.
constexpr const char* kPrefixes[] = {"OMP_PROC_BIND", "OMP_PLACES", "GOMP_CPU_AFFINITY",
                                     "KMP_AFFINITY"};

bool BindsThreads(const char* variable) {
  for (const char* prefix : kPrefixes) {
    int i = 0;
    while (prefix[i] != '\0' && variable[i] == prefix[i]) ++i;
    if (prefix[i] == '\0') return true;
  }
  return false;
}

// `environment` is the array that `environ` will point to. It is shortened in place.
void RemoveBindings(int, char**, char** environment) {
  int ignored = 0;
  char** kept = environment;
  for (char** variable = environment; *variable != nullptr; ++variable) {
    if (!BindsThreads(*variable)) {
      *kept++ = *variable;
    } else if (ignored < shoal::internal::kMostBindings) {
      shoal::internal::ignored_openmp_bindings[ignored++] = *variable;
    }
  }
  *kept = nullptr;
}

[[gnu::section(".preinit_array"), gnu::used]] void (*remove_bindings)(int, char**,
                                                                      char**) = RemoveBindings;

}  // namespace
