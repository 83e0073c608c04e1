// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_decisions.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "common/base/check.h"

namespace shoal::launch {

const char* ToString(RunEnd end) {
  switch (end) {
    case RunEnd::kTarget:
      return "target";
    case RunEnd::kBudget:
      return "budget";
    case RunEnd::kInterrupted:
      return "interrupted";
    case RunEnd::kFailed:
      return "failed";
  }
  return "?";
}

RunDecisions::RunDecisions(const Config& config, link::RunTopology topology, const RunMeta& before,
                           SteadyTime start)
    : topology_(std::move(topology)),
      env_steps_before_(before.env_steps),
      updates_before_(before.updates),
      config_(config),
      rule_(config),
      working_actors_(start) {}

void RunDecisions::Change(const Config& config) {
  config_ = config;
  rule_.Change(config);
}

std::optional<std::string> RunDecisions::Fail(const std::string& why) {
  if (!error_.empty()) return std::nullopt;  // keep the first error: later ones may repeat it
  error_ = why;
  return "error: " + why;
}

std::optional<std::string> RunDecisions::OnReplay(const ReplayProgress& progress) {
  if (!progress_.OnReplay(progress)) return std::nullopt;
  return fmt::format(
      "replay-{} starts empty, env steps continue from {}; training continues once it holds {} "
      "sampleable transitions again (replay.min_size)",
      progress.replay, env_steps(), config_.replay.min_size);
}

std::optional<std::string> RunDecisions::OnStandings(const RoleStanding& actors,
                                                     const RoleStanding& evaluation,
                                                     SteadyTime now) {
  actors_ = actors;
  evaluation_actor_ = evaluation;
  const std::chrono::seconds patience(config_.stop.without_actors);
  if (const auto why = working_actors_.Look(actors, patience, now)) return Fail(*why);
  if (const auto why = MissingEvaluations(evaluation, evaluated_)) return Fail(*why);
  return std::nullopt;
}

RunDecisions::Verdict RunDecisions::OnEvaluation(const EvaluationPoint& point) {
  evaluated_ = true;
  Verdict verdict{.best = false, .warning = Count(point)};
  verdict.best = bests_.newest_is_best();
  return verdict;
}

std::optional<std::string> RunDecisions::Count(const EvaluationPoint& point) {
  rule_.OnEvaluation(point);
  last_evaluation_ = point;
  bests_.OnEvaluation(point);
  return flat_.OnEvaluation(point, rule_.target());
}

std::optional<std::string> RunDecisions::BeginEnd(RunEnd end) {
  end_ = end;
  actors_ = evaluation_actor_ = {};
  switch (end) {
    case RunEnd::kTarget:
      return "the success asked for (stop.success) is reached: stopping the run";
    case RunEnd::kBudget:
      return "the budget (env_steps) is spent: stopping the run";
    case RunEnd::kInterrupted:
      return stop_commanded_ ? "stopping the run, as commanded"
                             : "stopping the run; Ctrl-C again to stop at once";
    case RunEnd::kFailed:
      return std::nullopt;  // Fail returned the line
  }
  return std::nullopt;
}

std::optional<std::string> RunDecisions::OnEnded() {
  if (end_ != RunEnd::kBudget || rule_.BudgetSpent(env_steps())) return std::nullopt;
  return Fail(fmt::format(
      "the learner died when the budget was spent: {} of {} env steps are left; --resume goes on",
      env_steps(), config_.env_steps));
}

bool RunDecisions::Started(const std::function<bool(const ProcessName&)>& has_reported) const {
  return std::ranges::all_of(topology_.children(), [&](const link::RunProcess& child) {
    const ProcessName name = child.Name();
    if (has_reported(name)) return true;
    const bool retired =
        child.role == link::Role::kActor && std::cmp_greater_equal(child.index, config_.actors);
    const bool down =
        actors_.working > 0 &&
        std::ranges::find(actors_.down, name.Text(), &DownProcess::name) != actors_.down.end();
    return retired || down;
  });
}

std::optional<RunEnd> RunDecisions::MustEnd(bool interrupted) const {
  if (!error_.empty()) return RunEnd::kFailed;
  if (interrupted || stop_commanded_) return RunEnd::kInterrupted;
  if (rule_.TargetReached()) return RunEnd::kTarget;
  // On policy the learner counts env steps; if it died, its last count may be lost.
  const bool counted = topology_.Has(link::Role::kReplay) || progress_.learner_lives();
  if (counted && rule_.BudgetSpent(env_steps())) return RunEnd::kBudget;
  return std::nullopt;
}

bool RunDecisions::CanDrain(int running_replays) const {
  return running_replays > 0 || !topology_.Has(link::Role::kReplay);
}

bool RunDecisions::Settled() const {
  const bool plays_to_the_end =
      end_ == RunEnd::kBudget || (config_.lockstep && end_ == RunEnd::kTarget);
  if (!plays_to_the_end) return true;
  if (!progress_.drained()) return false;
  return (last_evaluation_ ? last_evaluation_->updates : 0) >= progress_.evaluation_due();
}

RunEnd RunDecisions::FinalEnd() const {
  CHECK(end_.has_value()) << "the run goes on";
  return error_.empty() ? *end_ : RunEnd::kFailed;
}

uint64_t RunDecisions::env_steps() const {
  return std::max(env_steps_before_, progress_.stored_steps());
}

std::optional<EvaluationPoint> RunDecisions::best() const {
  const EvaluationPoint* best = bests_.best();
  return best == nullptr ? std::nullopt : std::optional(*best);
}

int RunDecisions::ActorsWorking() const {
  return config_.actors - static_cast<int>(actors_.down.size());
}

}  // namespace shoal::launch
