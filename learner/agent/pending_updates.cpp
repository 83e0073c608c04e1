// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/pending_updates.h"

#include <optional>
#include <span>
#include <utility>

namespace shoal::learner {

std::vector<UpdateOutcome> PendingUpdates::End() {
  const std::optional<Engine::Outcome> outcome = engine_->End();
  sheets_.push_back(std::exchange(*current_, {}));
  ++*updates_;
  if (!outcome) return {};
  return {Take(*outcome)};
}

std::vector<UpdateOutcome> PendingUpdates::Finish() {
  std::vector<UpdateOutcome> outcomes;
  while (!sheets_.empty()) outcomes.push_back(Take(engine_->WaitOutcome()));
  return outcomes;
}

UpdateOutcome PendingUpdates::Take(const Engine::Outcome& outcome) {
  const std::span<const float> errors = engine_->ReadErrors();
  UpdateOutcome update{.figures = sheets_.front().Read(*engine_, outcome),
                       .finite = outcome.finite,
                       .errors = {errors.begin(), errors.end()}};
  if (outcome.finite) {
    sheets_.pop_front();
  } else {
    *updates_ -= sheets_.size();
    sheets_.clear();
  }
  return update;
}

}  // namespace shoal::learner
