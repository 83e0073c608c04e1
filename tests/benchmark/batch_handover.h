// SPDX-License-Identifier: Apache-2.0
// Cost of handing batches from a replay to a learner, beside gathering them: the real sender
// and the real source in a process each, with an empty batch in place of a drawn one.
#pragma once

#include <cstdint>

namespace shoal::bench {

struct HandoverOptions {
  bool shared = true;  // through shared memory; else over the network, on this host
  int batch = 128;     // of two 84x84 RGB cameras
  int batches = 300;   // measured, after a few that are not
};

struct HandoverFigures {
  double gigabytes = 0;        // handed over
  double replay_seconds = 0;   // CPU of the replay's process
  double learner_seconds = 0;  // CPU of the learner's; it looks at one byte of each page
};

// In processes of its own; not to be called once this one has joined a DDS domain. Throws Error.
HandoverFigures MeasureHandover(const HandoverOptions& options);

}  // namespace shoal::bench
