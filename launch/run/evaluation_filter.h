// SPDX-License-Identifier: Apache-2.0
// Counts each evaluation once, in the order of the evaluated parameters. There are two sources of
// duplicates. After a pause longer than its lease, a reader seems new, and the transport delivers
// the stored messages again. A restarted evaluation actor plays the newest parameters again. If
// duplicates counted, a single evaluation could stop a run. Pure.
#pragma once

#include <cstdint>
#include <set>
#include <utility>

#include "common/wire/messages.h"
#include "launch/record/evaluation_point.h"

namespace shoal::launch {

class EvaluationFilter {
 public:
  // Returns true if the point counts: its parameters are newer than the parameters of all earlier
  // points, and no earlier point had the same env steps and updates (a resumed learner may request
  // an evaluation of a checkpoint that has been evaluated before). Returns false for a duplicate,
  // and for a point that is older than another counted point.
  bool Accept(const EvaluationPoint& point);

  // Number of points that did not count.
  uint64_t repeated() const { return repeated_; }

 private:
  WeightsVersion newest_;
  std::set<std::pair<uint64_t, uint64_t>> counted_;  // (env steps, updates) of counted points
  uint64_t repeated_ = 0;
};

}  // namespace shoal::launch
