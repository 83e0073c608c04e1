// SPDX-License-Identifier: Apache-2.0
// The connection of an actor session to the receiver of its records: credits in, chunks out.
#pragma once

#include <optional>

#include "common/base/clock.h"
#include "common/wire/messages.h"

namespace shoal::actor {

class ChunkLink {
 public:
  virtual ~ChunkLink() = default;
  // Returns the newest credit of this session if it has not been returned before. Waits for a
  // credit until `deadline`.
  virtual std::optional<Credit> TakeCredit(SteadyTime deadline) = 0;
  // True if a receiver is connected. Without a receiver, chunks that are sent now are lost.
  virtual bool Connected() = 0;
  // Sends a chunk. False if the transport did not accept the chunk in time; try again later.
  virtual bool Send(const TransitionChunk& chunk) = 0;
};

}  // namespace shoal::actor
