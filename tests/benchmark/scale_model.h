// SPDX-License-Identifier: Apache-2.0
// Capacity of one replay server, one learner and one link, computed from measured rows: the tables
// of docs/scale.md.
//
// A run makes `t` transitions per second. The learner draws S = replay.samples_per_insert samples
// per transition, which is t S / B batches per second. Loads, as shares of the capacity:
//
//   replay    t (intake + S / B (gather + batch_bytes * handover))   of one core
//   learner   t S / B * update                                       of one core
//   link in   t * record_bytes                                       of the replay host's link
//   link out  t S / B * batch_bytes                                  of this link, to a far learner
#pragma once

#include <span>
#include <string>

#include "tests/benchmark/bench_report.h"

namespace shoal::bench {

// Batch size in these rows.
inline constexpr double kScaleBatch = 128;

// Measured values. All except actor_rate are CPU seconds of one core.
struct ScaleConstants {
  double actor_rate = 0;                       // transitions/s of one actor on its own core
  double intake = 0;                           // of the replay, per transition
  double gather = 0;                           // of the replay, per batch
  double handover_near = 0, handover_far = 0;  // of the replay, per byte: same host, other host
  double update = 0;                           // of the learner, per batch
};

// Reads the rows that shoal-bench, shoal-bench-batches and shoal-bench-actors write. If a row is
// missing, throws Error naming the row.
ScaleConstants ReadScaleConstants(std::span<const Report> reports);

struct ScaleLoad {
  double replay = 0, learner = 0, link_in = 0, link_out = 0;  // 1 = full capacity
};

// `far`: learner and replay server are on different hosts.
ScaleLoad LoadOf(const ScaleConstants& constants, double transitions_per_second,
                 double samples_per_insert, bool far);

// Markdown: the constants with their rows, the capacity of one replay server, learner and link, the
// loads of 16, 100 and 1,000 actors, and the limit that is exceeded first.
std::string ScaleTables(const ScaleConstants& constants);

}  // namespace shoal::bench
