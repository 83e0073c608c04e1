#include "replay_server/core/storage_needs.h"

#include "common/config/batch_options.h"
#include "replay_server/core/episode_index.h"
#include "replay_server/core/ring_format.h"

namespace shoal::replay {

StorageNeeds StorageNeedsOf(const RunConfig& run) {
  const RingGeometry geometry(run.spec, static_cast<uint64_t>(run.config.replay.capacity));
  return {.ring_bytes = geometry.total_bytes(),
          .memory_bytes = EpisodeIndex::Bytes(geometry.capacity),
          .batch_bytes = BatchSchemaOf(run).total_bytes()};
}

}  // namespace shoal::replay
