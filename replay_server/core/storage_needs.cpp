// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/storage_needs.h"

#include "common/config/batch_options.h"
#include "common/config/priorities.h"
#include "replay_server/core/episode_index.h"
#include "replay_server/core/movement_selector.h"
#include "replay_server/core/priority_selector.h"
#include "replay_server/core/ring_format.h"

namespace shoal::replay {

StorageNeeds StorageNeedsOf(const RunConfig& run) {
  const RingGeometry geometry(run.spec, static_cast<uint64_t>(run.config.replay.capacity));
  uint64_t memory = EpisodeIndex::Bytes(geometry.capacity);
  if (run.config.replay.movement_share > 0) memory += MovementSelector::Bytes(geometry.capacity);
  if (HasPriorities(run.config.replay)) memory += PrioritySelector::Bytes(geometry.capacity);
  return {.ring_bytes = geometry.total_bytes(),
          .memory_bytes = memory,
          .batch_bytes = BatchSchemaOf(run).total_bytes()};
}

}  // namespace shoal::replay
