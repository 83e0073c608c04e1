// SPDX-License-Identifier: Apache-2.0
// Which evaluations count: each one once, in the order of the parameters they are of. The transport
// delivers what it keeps again to a reader that it takes for new (after a pause longer than its
// lease), and a restarted evaluation actor plays the newest parameters again; a run that counted
// those would stop for one evaluation told twice. Pure.
#pragma once

#include <cstdint>
#include <set>
#include <utility>

#include "common/wire/messages.h"
#include "launch/record/evaluation_point.h"

namespace shoal::launch {

class EvaluationFilter {
 public:
  // True when the point counts: its parameters are newer than those of every point before, and no
  // point before had its env steps and updates (a resumed learner may hand out the checkpoint that
  // its predecessor had evaluated). False: it was counted already, or overtaken.
  bool Accept(const EvaluationPoint& point);

  // Points that did not count.
  uint64_t repeated() const { return repeated_; }

 private:
  WeightsVersion newest_;
  std::set<std::pair<uint64_t, uint64_t>> counted_;  // env steps, updates: a file under eval/ each
  uint64_t repeated_ = 0;
};

}  // namespace shoal::launch
