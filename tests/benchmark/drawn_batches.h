// SPDX-License-Identifier: Apache-2.0
// Batches that a replay server draws for a learner that only requests them. The replay server and
// the learner's receiver are the real ones, in one process each on this host.
#pragma once

#include <filesystem>

namespace shoal::bench {

struct DrawnOptions {
  std::filesystem::path folder;  // of the run; an empty folder with room for the ring
  int batch = 128;               // batch size, with two 84x84 RGB cameras
  int records = 10'000;          // records in the ring
  int credits = 3;               // learner.request_credits
  int threads = 0;               // replay.threads
  double seconds = 5;            // length of the measurement, after a warm-up
};

struct DrawnFigures {
  double batches_per_second = 0;
  double replay_seconds = 0;   // CPU time of the replay's process per batch
  double learner_seconds = 0;  // CPU time of the learner's process per batch
};

// Forks processes, so it must be called before this process joins a DDS domain. Throws Error.
DrawnFigures MeasureDrawn(const DrawnOptions& options);

}  // namespace shoal::bench
