// SPDX-License-Identifier: Apache-2.0
#include "common/base/openmp_binding.h"

namespace shoal {

constinit const char* internal::ignored_openmp_bindings[kMostBindings] = {};

std::vector<std::string> IgnoredOpenMpBindings() {
  std::vector<std::string> bindings;
  for (const char* binding : internal::ignored_openmp_bindings) {
    if (binding != nullptr) bindings.emplace_back(binding);
  }
  return bindings;
}

}  // namespace shoal
