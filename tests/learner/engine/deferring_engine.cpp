// SPDX-License-Identifier: Apache-2.0
#include "tests/learner/engine/deferring_engine.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/check.h"
#include "common/nn/host_memory.h"

namespace shoal::learner {

Number DeferringEngine::NewNumber() { return numbers_.emplace_back(RecordingEngine::NewNumber()); }

void DeferringEngine::Begin(const BatchView& drawn) {
  TakeOperations();
  BatchView batch = drawn;
  // Updates behind one that is not finite have no effect.
  if (std::ranges::any_of(in_flight_, [](const Ended& each) { return !each.outcome.finite; })) {
    not_a_number_.assign(drawn.rows(), NAN);
    batch.reward = not_a_number_;
  }
  RecordingEngine::Begin(batch);
}

std::optional<Engine::Outcome> DeferringEngine::End() {
  const std::optional<Outcome> outcome = RecordingEngine::End();
  CHECK(outcome.has_value());
  Ended& ended = in_flight_.emplace_back(Ended{*outcome, {}, {}});
  const std::span<const float> errors = RecordingEngine::ReadErrors();
  ended.errors.assign(errors.begin(), errors.end());
  for (const Number number : numbers_) {
    ended.numbers[nn::HostValues(number).data()] = RecordingEngine::Read(number);
  }
  if (in_flight_.size() <= delay_) return std::nullopt;
  return WaitOutcome();
}

Engine::Outcome DeferringEngine::WaitOutcome() {
  CHECK(!in_flight_.empty());
  Ended ended = std::move(in_flight_.front());
  in_flight_.pop_front();
  if (!ended.outcome.finite) in_flight_.clear();
  known_ = std::move(ended.numbers);
  known_errors_ = std::move(ended.errors);
  return ended.outcome;
}

double DeferringEngine::Read(Number number) const {
  if (!known_) return RecordingEngine::Read(number);
  return known_->at(nn::HostValues(number).data());
}

}  // namespace shoal::learner
