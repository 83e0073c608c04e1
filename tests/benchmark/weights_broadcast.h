// SPDX-License-Identifier: Apache-2.0
// Cost of sending a learner's weights to the actors of its host. Real processes run only the
// learner's sender, the actors' inboxes over DDS, and the loading into a policy, layouts included.
#pragma once

#include <cstdint>
#include <string>

namespace shoal::bench {

struct BroadcastOptions {
  std::string encoder = "nature";  // of two 84x84 RGB cameras
  int actors = 16;
  double versions_per_second = 2;
  double seconds = 10;  // with weights; then equally long without
};

// Shares of one core; CPU time of all processes together unless stated otherwise.
struct BroadcastFigures {
  double learner = 0,
         actors = 0;         // of each side for the weights, minus `idle`
  double idle = 0;           // background work of DDS while no weights are sent
  double taken = 0;          // share of the versions sent to an actor that it loaded
  double version_bytes = 0;  // sent to each actor
};

// Throws Error if an actor does not receive the last version.
BroadcastFigures MeasureBroadcast(const BroadcastOptions& options);

}  // namespace shoal::bench
