// SPDX-License-Identifier: Apache-2.0
// An engine that has several updates in flight, as an engine of a GPU has: another engine computes
// each update at once, but outcome and numbers are returned `delay` updates later. Of that other
// engine nothing is read in the meantime, and its numbers change.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "tests/learner/engine/recording_engine.h"

namespace shoal::learner {

// RecordingEngine passes each operation on; its record is not used here.
class DeferringEngine final : public RecordingEngine {
 public:
  // Borrows the engine, whose End must return the update's own outcome.
  DeferringEngine(Engine* engine, size_t delay) : RecordingEngine(engine), delay_(delay) {}

  Number NewNumber() override;
  void Begin(const BatchView& drawn) override;
  std::optional<Outcome> End() override;
  Outcome WaitOutcome() override;
  double Read(Number number) const override;
  std::span<const float> ReadErrors() const override { return known_errors_; }

  size_t in_flight() const { return in_flight_.size(); }

 private:
  using Values = std::map<const double*, double>;  // by the numbers' places
  struct Ended {
    Outcome outcome;
    Values numbers;
    std::vector<float> errors;
  };

  const size_t delay_;
  std::vector<Number> numbers_;
  std::deque<Ended> in_flight_;
  std::optional<Values> known_;  // numbers of the update whose outcome was returned last
  std::vector<float> known_errors_;
  std::vector<float> not_a_number_;
};

}  // namespace shoal::learner
