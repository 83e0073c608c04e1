// SPDX-License-Identifier: Apache-2.0
// Storage that a replay needs for a configuration, for checks of available room.
#pragma once

#include <cstdint>

#include "common/config/run_config.h"

namespace shoal::replay {

struct StorageNeeds {
  uint64_t ring_bytes = 0;    // file or memory, by replay.storage
  uint64_t memory_bytes = 0;  // beside the ring, in memory always
  uint64_t batch_bytes = 0;   // of one batch
};

StorageNeeds StorageNeedsOf(const RunConfig& run);

}  // namespace shoal::replay
