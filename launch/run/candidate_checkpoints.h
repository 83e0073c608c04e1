// SPDX-License-Identifier: Apache-2.0
// Chooses the checkpoints that a run keeps after the learner has pruned its own: the checkpoints of
// the evaluations that are the best or may become the best (best_evaluation.h). Pure.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "launch/record/evaluation_point.h"

namespace shoal::launch {

struct CheckpointChoice {
  std::vector<std::string> names{};  // of the checkpoints to keep; may be empty
  std::string best{};                // one of them
  std::vector<std::string> lines{};  // for people
};

class CandidateCheckpoints {
 public:
  // `unwritten`: number of checkpoints that the learner could not write, from its last report.
  // Returns a line when the learner begins to fail, and when it has written its checkpoints. `log`:
  // the learner's log.
  std::optional<std::string> OnUnwritten(double unwritten, const std::string& learner,
                                         const std::string& log);

  // `candidates`: BestEvaluation::candidates(). `exists` says whether a checkpoint of that name was
  // written. While the learner cannot write, missing checkpoints are not left out, because the
  // learner will write them later. Returns nothing if an evaluation names no checkpoint.
  std::optional<CheckpointChoice> Choose(std::vector<EvaluationPoint> candidates,
                                         const std::function<bool(const std::string&)>& exists);

 private:
  bool learner_fails_ = false;
  std::set<std::string> gone_;  // checkpoints never written; one line for each
};

}  // namespace shoal::launch
