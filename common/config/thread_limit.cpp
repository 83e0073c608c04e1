// SPDX-License-Identifier: Apache-2.0
#include "common/config/thread_limit.h"

#include <string>

#include "common/base/error.h"

namespace shoal {

void CheckCores(std::string_view key, int threads, const CoreLimits& limits) {
  const int cores = UsableCores(limits);
  if (threads <= cores) return;
  const std::string why = DescribeLimits(limits);
  throw UsageError(
      "{} = {}: this process may use {} core{}{}, expected at most as many threads (--set {}=N; 0 "
      "takes what suits the cores)",
      key, threads, cores, cores == 1 ? "" : "s", why.empty() ? "" : ": " + why, key);
}

}  // namespace shoal
