// SPDX-License-Identifier: Apache-2.0
// Chooses the checkpoints that a run keeps after the learner has deleted its older checkpoints: the
// checkpoints of the best evaluation and of evaluations that may become the best
// (best_evaluation.h). Pure.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "launch/record/evaluation_point.h"

namespace shoal::launch {

struct CheckpointChoice {
  std::vector<std::string> names{};  // names of the checkpoints to keep; may be empty
  std::string best{};                // one of `names`
  std::vector<std::string> lines{};  // for people
};

class CandidateCheckpoints {
 public:
  // `unwritten`: number of checkpoints that the learner could not write, from its last report.
  // Returns a line when the learner first fails to write, and when it has written all checkpoints.
  // `log`: the learner's log.
  std::optional<std::string> OnUnwritten(double unwritten, const std::string& learner,
                                         const std::string& log);

  // `candidates`: BestEvaluation::candidates(). `exists` returns whether a checkpoint of that name
  // was written. While the learner cannot write, missing checkpoints are not left out, because the
  // learner will write them later. Returns nothing if an evaluation has no checkpoint name.
  std::optional<CheckpointChoice> Choose(std::vector<EvaluationPoint> candidates,
                                         const std::function<bool(const std::string&)>& exists);

 private:
  bool learner_fails_ = false;
  std::set<std::string> gone_;  // checkpoints never written; one line for each
};

}  // namespace shoal::launch
