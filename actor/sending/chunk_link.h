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
  // The newest credit of this session that was not taken before; waits for one until `deadline`.
  virtual std::optional<Credit> TakeCredit(SteadyTime deadline) = 0;
  // Whether a receiver is connected: without one, chunks that are sent now are lost.
  virtual bool Connected() = 0;
  // False when the transport did not take the chunk in its time: try again later.
  virtual bool Send(const TransitionChunk& chunk) = 0;
};

}  // namespace shoal::actor
