// SPDX-License-Identifier: Apache-2.0
// Lock that allows one process per actor of a run. An actor's number determines its environments,
// so two processes with the same number would play the same episodes.
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
  // Takes the lock. If an earlier process of this actor is still sending its last records, waits up
  // to `deadline`, or until `stop` returns true. If the lock stays taken, throws Error naming the
  // lock.
  ActorLock(const std::filesystem::path& run, uint32_t actor, std::chrono::seconds deadline,
            const std::function<bool()>& stop);

 private:
  std::optional<FileLock> lock_;
};

}  // namespace shoal::actor
