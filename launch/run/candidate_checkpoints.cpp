// SPDX-License-Identifier: Apache-2.0
#include "launch/run/candidate_checkpoints.h"

#include <fmt/core.h>

#include <algorithm>

namespace shoal::launch {

std::optional<std::string> CandidateCheckpoints::OnUnwritten(double unwritten,
                                                             const std::string& learner,
                                                             const std::string& log) {
  if ((unwritten > 0) == learner_fails_) return std::nullopt;
  learner_fails_ = unwritten > 0;
  if (!learner_fails_) return fmt::format("{} has written its checkpoints", learner);
  return fmt::format("{} cannot write its checkpoints: it keeps them and tries again; why: {}",
                     learner, log);
}

std::optional<CheckpointChoice> CandidateCheckpoints::Choose(
    std::vector<EvaluationPoint> candidates,
    const std::function<bool(const std::string&)>& exists) {
  if (std::ranges::any_of(candidates, &std::string::empty, &EvaluationPoint::checkpoint)) {
    return std::nullopt;
  }
  CheckpointChoice choice;
  // While the learner cannot write, it drops older checkpoints. Once it can write again, missing
  // checkpoints stay missing, and the best is chosen among the others.
  if (!learner_fails_) {
    std::erase_if(candidates, [&](const EvaluationPoint& point) {
      if (exists(point.checkpoint)) return false;
      if (gone_.insert(point.checkpoint).second) {
        choice.lines.push_back(fmt::format(
            "checkpoint {} was never written: the best is chosen without it", point.checkpoint));
      }
      return true;
    });
  }
  if (candidates.empty()) return choice;
  for (const EvaluationPoint& candidate : candidates) choice.names.push_back(candidate.checkpoint);
  choice.best = std::ranges::max_element(candidates, {}, &EvaluationPoint::mean_return)->checkpoint;
  return choice;
}

}  // namespace shoal::launch
