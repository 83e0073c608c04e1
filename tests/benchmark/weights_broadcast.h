// SPDX-License-Identifier: Apache-2.0
// Cost of sending a learner's weights to the actors of its host. Separate processes run only the
// learner's sender, the actors' inboxes over DDS, and the loading into a policy, including the
// conversion of layouts.
#pragma once

#include <cstdint>
#include <string>

namespace shoal::bench {

struct BroadcastOptions {
  std::string encoder = "nature";  // for two 84x84 RGB cameras
  int actors = 16;
  double versions_per_second = 2;
  double seconds = 10;  // length of the measurement with weights, and of that without weights
};

// Shares of one core; CPU time of all processes together unless stated otherwise.
struct BroadcastFigures {
  double learner = 0,
         actors = 0;         // CPU time of each side for the weights, minus `idle`
  double idle = 0;           // CPU time of DDS while no weights are sent
  double taken = 0;          // share of the sent versions that an actor loaded
  double version_bytes = 0;  // bytes of a version, sent to each actor
};

// Throws Error if an actor does not receive the last version.
BroadcastFigures MeasureBroadcast(const BroadcastOptions& options);

}  // namespace shoal::bench
