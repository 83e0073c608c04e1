// SPDX-License-Identifier: Apache-2.0
// Cost of passing batches from replay server to learner, without gathering them. The real sender
// and the real receiver run in one process each and pass empty batches.
#pragma once

#include <cstdint>

namespace shoal::bench {

struct HandoverOptions {
  bool shared = true;  // through shared memory; else over DDS on this host
  int batch = 128;     // of two 84x84 RGB cameras
  int batches = 300;   // measured, after a few for warming up
};

struct HandoverFigures {
  double gigabytes = 0;        // passed
  double replay_seconds = 0;   // CPU of the replay's process
  double learner_seconds = 0;  // CPU of the learner's process, which reads one byte of each page
};

// Forks processes, so it must be called before this process joins a DDS domain. Throws Error.
HandoverFigures MeasureHandover(const HandoverOptions& options);

}  // namespace shoal::bench
