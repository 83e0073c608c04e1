// SPDX-License-Identifier: Apache-2.0
#include "common/base/clock.h"

#include <ctime>

namespace shoal {

std::string UtcTimestamp() {
  const std::time_t now = WallTimeNs() / 1'000'000'000;
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

}  // namespace shoal
