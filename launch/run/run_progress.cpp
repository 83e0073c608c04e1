// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_progress.h"

#include <algorithm>

namespace shoal::launch {

bool RunProgress::OnReplay(const ReplayProgress& progress) {
  ReplayProgress& known = replays_[progress.replay];
  const bool emptied =
      progress.session > known.session && progress.stored_records < known.stored_records;
  if (progress.session >= known.session) known = progress;
  uint64_t steps = 0;
  for (const auto& [replay, newest] : replays_) steps += newest.stored_steps;
  env_steps_ = std::max(env_steps_, steps);
  return emptied;
}

void RunProgress::OnLearner(const LearnerProgress& progress) {
  if (progress.session < learner_.session) return;
  learner_ = progress;
  for (const EvaluationRequest& request : progress.evaluations) {
    asked_[{progress.session, request.update}] = request;
  }
}

uint64_t RunProgress::stored_steps() const {
  return replays_.empty() ? learner_.env_steps : env_steps_;
}

std::optional<uint64_t> RunProgress::updates() const {
  return learner_.session == 0 ? std::nullopt : std::optional(learner_.updates);
}

uint64_t RunProgress::evaluation_due() const {
  return learner_.evaluations.empty() ? 0 : learner_.evaluations.back().update;
}

bool RunProgress::AskedFor(const EvaluationPoint& point) const {
  const auto it = asked_.find({point.learner_session, point.updates});
  return it != asked_.end() && it->second.env_steps == point.env_steps &&
         it->second.checkpoint == point.checkpoint;
}

}  // namespace shoal::launch
