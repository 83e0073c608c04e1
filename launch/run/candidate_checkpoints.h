// SPDX-License-Identifier: Apache-2.0
// Which checkpoints a run keeps beyond the learner's own pruning: those of the evaluations that are
// the best or may become it (best_evaluation.h). Pure.
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
  // `unwritten`: how many checkpoints the learner has not been able to write, by its last report.
  // Returns a line when it begins to fail and when it has written them. `log`: the learner's.
  std::optional<std::string> OnUnwritten(double unwritten, const std::string& learner,
                                         const std::string& log);

  // `candidates`: BestEvaluation::candidates(). `exists` says whether a checkpoint of that name was
  // written. While the learner cannot write, the choice takes for granted that it will. Empty when
  // an evaluation names no checkpoint: there is nothing to keep.
  std::optional<CheckpointChoice> Choose(std::vector<EvaluationPoint> candidates,
                                         const std::function<bool(const std::string&)>& exists);

 private:
  bool learner_fails_ = false;
  std::set<std::string> gone_;  // checkpoints that were never written: said once each
};

}  // namespace shoal::launch
