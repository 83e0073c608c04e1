// SPDX-License-Identifier: Apache-2.0
// Where a learner's batches come from, over DDS: drawn by a replay, or rollouts of the actors
// themselves.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "common/config/run_config.h"
#include "common/dds/bus.h"
#include "learner/batch_stream.h"

namespace shoal::learner {

class BatchFeed {
 public:
  virtual ~BatchFeed() = default;
  virtual BatchStream& stream() = 0;
  // When the coordinator is gone: whoever still sends gets his answer.
  virtual void SayFarewell() {}
};

// As the run's algorithm learns; `updates`: done before. Borrows the bus. Throws Error.
std::unique_ptr<BatchFeed> MakeFeed(const std::filesystem::path& folder, const RunConfig& run,
                                    uint64_t learner_session, uint64_t updates, dds::Bus& bus);

}  // namespace shoal::learner
