// SPDX-License-Identifier: Apache-2.0
// One process per actor of a run: its number names its environments, and two that hosted the same
// would play the same episodes.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "common/base/file_lock.h"

namespace shoal::actor {

// Holds RUN/made/actor-ID.lock until destruction or the process's death.
class ActorLock {
 public:
  // Waits up to `deadline` for a predecessor that is still sending its last records, unless `stop`.
  // Throws Error naming the lock when it is not had.
  ActorLock(const std::filesystem::path& run, uint32_t actor, std::chrono::seconds deadline,
            const std::function<bool()>& stop);

 private:
  std::optional<FileLock> lock_;
};

}  // namespace shoal::actor
