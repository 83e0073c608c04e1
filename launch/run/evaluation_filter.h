// SPDX-License-Identifier: Apache-2.0
// Counts each evaluation once, in the order of the evaluated parameters. Duplicates are possible:
// the transport delivers its kept messages again to a reader that seems new (after a pause longer
// than its lease), and a restarted evaluation actor plays the newest parameters again. A run that
// counted duplicates could stop because of one evaluation. Pure.
#pragma once

#include <cstdint>
#include <set>
#include <utility>

#include "common/wire/messages.h"
#include "launch/record/evaluation_point.h"

namespace shoal::launch {

class EvaluationFilter {
 public:
  // Returns true if the point counts: its parameters are newer than those of every earlier point,
  // and no earlier point had the same env steps and updates (a resumed learner may request an
  // evaluation of a checkpoint that has been evaluated). Returns false for a duplicate or an
  // overtaken point.
  bool Accept(const EvaluationPoint& point);

  // Points that did not count.
  uint64_t repeated() const { return repeated_; }

 private:
  WeightsVersion newest_;
  std::set<std::pair<uint64_t, uint64_t>> counted_;  // env steps, updates: a file under eval/ each
  uint64_t repeated_ = 0;
};

}  // namespace shoal::launch
