// SPDX-License-Identifier: Apache-2.0
// Selects the received evaluations that a run counts: valid evaluations of parameters that the
// learner sent for evaluation, each once. Other evaluations are refused or left out, counted and
// reported. No message can end the run. Pure.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/wire/messages.h"
#include "launch/record/evaluation_point.h"
#include "launch/run/evaluation_filter.h"
#include "launch/run/run_progress.h"

namespace shoal::launch {

class EvaluationIntake {
 public:
  // `episodes`: number of episodes of each evaluation. Borrows `progress`. `say` gets a line about
  // refusals, at most once per kSayPeriod.
  EvaluationIntake(int episodes, const RunProgress& progress,
                   std::function<void(const std::string&)> say);

  // Marks an evaluation that an earlier session of the run has counted.
  void Recall(const EvaluationPoint& point) { filter_.Accept(point); }

  // Takes the messages received since the last call and returns the messages that count, in order
  // of arrival. If an evaluation arrives before the learner's message that announces this
  // evaluation, the evaluation waits for up to kWait.
  std::vector<EvalMessage> Take(std::vector<EvalMessage> messages, SteadyTime now);

  // Call at the end of the run. Refuses the evaluations that still wait.
  void End(SteadyTime now);

  uint64_t refused() const { return refused_; }
  uint64_t repeated() const { return filter_.repeated(); }

  static constexpr std::chrono::seconds kWait{10}, kSayPeriod{10};
  static constexpr size_t kMostWaiting = 64;

 private:
  struct Waiting {
    EvalMessage message;
    EvaluationPoint point;
    SteadyTime arrived;
  };

  // Results in the message. Throws Error if the results are impossible.
  EvaluationPoint Figures(const EvalMessage& message) const;
  void Refuse(const std::string& why, SteadyTime now);

  const size_t episodes_;
  const RunProgress& progress_;
  const std::function<void(const std::string&)> say_;
  EvaluationFilter filter_;
  std::vector<Waiting> waiting_;
  uint64_t refused_ = 0;
  std::optional<SteadyTime> said_;
};

}  // namespace shoal::launch
