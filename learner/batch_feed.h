// SPDX-License-Identifier: Apache-2.0
// The source of a learner's batches over the link: batches drawn by a replay, or rollouts sent by
// the actors.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "common/config/run_config.h"
#include "common/link/hub.h"
#include "learner/batch_stream.h"
#include "learner/pin_memory.h"

namespace shoal::learner {

class BatchFeed {
 public:
  virtual ~BatchFeed() = default;
  virtual BatchStream& stream() = 0;
  // After the coordinator is lost, continues to acknowledge chunks until no more chunks arrive.
  virtual void DrainAfterCoordinatorLoss() {}
};

// Makes the feed that the run's algorithm needs: batches of a replay, or rollouts. `updates`:
// number of updates before the start. `pin` is given the memory of batches that a replay has drawn.
// Borrows the hub. Throws Error.
std::unique_ptr<BatchFeed> MakeFeed(const std::filesystem::path& folder, const RunConfig& run,
                                    uint64_t learner_session, uint64_t updates, link::Hub& hub,
                                    PinMemory pin);

}  // namespace shoal::learner
