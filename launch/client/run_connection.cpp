// SPDX-License-Identifier: Apache-2.0
#include "launch/client/run_connection.h"

#include <unistd.h>

#include "common/base/clock.h"
#include "common/base/random.h"

namespace shoal::launch {
namespace {

uint64_t MakeClientId() {
  return HashWords({static_cast<uint64_t>(WallTimeNs()), static_cast<uint64_t>(getpid())}) | 1;
}

}  // namespace

RunConnection::RunConnection(const RunTarget& target)
    : bus_(target.address, target.transport, dds::Role::kClient),
      client_(bus_, target, MakeClientId()) {}

}  // namespace shoal::launch
