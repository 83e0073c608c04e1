// SPDX-License-Identifier: Apache-2.0
// Cost for a host of sending its learner's weights to its actors: real processes, the sender of
// the learner, the inboxes of actors over DDS and the loading into a policy that acts, layouts
// included, and nothing else that these do.
#pragma once

#include <cstdint>
#include <string>

namespace shoal::bench {

struct BroadcastOptions {
  std::string encoder = "nature";  // of two 84x84 RGB cameras
  int actors = 16;
  double versions_per_second = 2;
  double seconds = 10;  // with weights, and as long without
};

// Shares of one core, of all the processes' CPU time together where nothing else is said.
struct BroadcastFigures {
  double learner = 0,
         actors = 0;         // of each side, for the weights: without what the idle time takes
  double idle = 0;           // while no weights are sent: what DDS does by itself
  double taken = 0;          // of the versions sent to each actor, those that it acted by
  double version_bytes = 0;  // sent to each actor
};

// Throws Error when an actor does not get the last version.
BroadcastFigures MeasureBroadcast(const BroadcastOptions& options);

}  // namespace shoal::bench
