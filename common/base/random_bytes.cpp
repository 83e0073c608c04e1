// SPDX-License-Identifier: Apache-2.0
#include "common/base/random_bytes.h"

#include <sys/random.h>

#include <cerrno>
#include <cstring>

#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal {

void FillWithRandomBytes(std::span<std::byte> bytes) {
  CHECK(bytes.size() <= 256) << bytes.size();  // the most that getrandom returns in one call
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw RuntimeError("the kernel gives no random bytes: {}", std::strerror(errno));
  }
}

}  // namespace shoal
