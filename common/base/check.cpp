// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.h"

#include <cstdlib>
#include <iostream>

namespace shoal::internal {

CheckFailure::CheckFailure(const char* file, int line, const char* condition) {
  stream_ << file << ':' << line << ": CHECK failed: " << condition << ' ';
}

CheckFailure::~CheckFailure() {
  std::cerr << stream_.str() << std::endl;
  std::abort();
}

}  // namespace shoal::internal
