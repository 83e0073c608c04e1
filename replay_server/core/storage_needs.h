// SPDX-License-Identifier: Apache-2.0
// Storage that the replay needs for a configuration, for checks of the available space.
#pragma once

#include <cstdint>

#include "common/config/run_config.h"

namespace shoal::replay {

struct StorageNeeds {
  uint64_t ring_bytes = 0;    // ring, in a file or in memory (replay.storage)
  uint64_t memory_bytes = 0;  // memory in addition to the ring
  uint64_t batch_bytes = 0;   // one batch
};

StorageNeeds StorageNeedsOf(const RunConfig& run);

}  // namespace shoal::replay
