// SPDX-License-Identifier: Apache-2.0
#include "common/base/write_faults.h"

#include <fmt/core.h>

#include "common/base/error.h"

namespace shoal {

bool WriteFaults::Try(const std::string& what, const std::function<void()>& write) {
  try {
    write();
  } catch (const Error& e) {
    if (failing_.insert(what).second) {
      say_(fmt::format("{}: {}; the data is kept and the write is retried", what, e.what()));
    }
    return false;
  }
  if (failing_.erase(what) > 0) say_(fmt::format("{}: written again", what));
  return true;
}

}  // namespace shoal
