// SPDX-License-Identifier: Apache-2.0
#include "launch/run/evaluation_intake.h"

#include <fmt/core.h>

#include <utility>

#include "common/base/error.h"
#include "common/base/one_line.h"
#include "launch/record/evaluations.h"

namespace shoal::launch {
namespace {

constexpr size_t kLineBytes = 300;

}  // namespace

EvaluationIntake::EvaluationIntake(int episodes, const RunProgress& progress,
                                   std::function<void(const std::string&)> say)
    : episodes_(static_cast<size_t>(episodes)), progress_(progress), say_(std::move(say)) {}

std::vector<EvalMessage> EvaluationIntake::Take(std::vector<EvalMessage> messages, SteadyTime now) {
  std::vector<Waiting> all = std::exchange(waiting_, {});
  for (EvalMessage& message : messages) {
    try {
      const EvaluationPoint point = Figures(message);
      all.push_back({std::move(message), point, now});
    } catch (const Error& e) {
      Refuse(e.what(), now);
    }
  }
  std::vector<EvalMessage> counted;
  for (Waiting& evaluation : all) {
    if (progress_.AskedFor(evaluation.point)) {
      if (filter_.Accept(evaluation.point)) counted.push_back(std::move(evaluation.message));
    } else if (now - evaluation.arrived < kWait && waiting_.size() < kMostWaiting) {
      waiting_.push_back(std::move(evaluation));
    } else {
      Refuse(fmt::format("evaluation at {} env steps: the learner sent no such weights",
                         evaluation.point.env_steps),
             now);
    }
  }
  return counted;
}

EvaluationPoint EvaluationIntake::Figures(const EvalMessage& message) const {
  EvaluationPoint point = ParseEvaluation(message);
  if (point.episodes != episodes_) {
    throw RuntimeError("evaluation at {} env steps: {} episodes, eval.episodes is {}",
                       point.env_steps, point.episodes, episodes_);
  }
  return point;
}

void EvaluationIntake::End(SteadyTime now) {
  for (const Waiting& evaluation : std::exchange(waiting_, {})) {
    Refuse(
        fmt::format(
            "evaluation at {} env steps: the run ended before the learner reported these weights",
            evaluation.point.env_steps),
        now);
  }
}

void EvaluationIntake::Refuse(const std::string& why, SteadyTime now) {
  ++refused_;
  if (said_ && now - *said_ < kSayPeriod) return;
  said_ = now;
  say_(Shortened(fmt::format("evaluation refused ({} in all): {}", refused_, why), kLineBytes));
}

}  // namespace shoal::launch
