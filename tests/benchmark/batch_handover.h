// SPDX-License-Identifier: Apache-2.0
// Cost of passing batches from replay server to learner, without the cost of gathering. The real
// sender and the real receiver run in one process each and pass empty batches.
#pragma once

#include <cstdint>

namespace shoal::bench {

struct HandoverOptions {
  bool shared = true;  // true: through shared memory; false: over DDS on this host
  int batch = 128;     // batch size, with two 84x84 RGB cameras
  int batches = 300;   // number of measured batches; a few warm-up batches come before
};

struct HandoverFigures {
  double gigabytes = 0;        // size of the passed batches
  double replay_seconds = 0;   // CPU of the replay's process
  double learner_seconds = 0;  // CPU of the learner's process, which reads one byte of each page
};

// Forks processes, so it must be called before this process joins a DDS domain. Throws Error.
HandoverFigures MeasureHandover(const HandoverOptions& options);

}  // namespace shoal::bench
