// SPDX-License-Identifier: Apache-2.0
// The decisions of a run: whether it has started, when and why it ends, when its processes may
// stop, and the lines to print. Pure: the caller supplies progress, commands and times.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/config/config.h"
#include "common/link/run_topology.h"
#include "common/wire/messages.h"
#include "launch/processes/supervisor.h"
#include "launch/record/run_meta.h"
#include "launch/run/best_evaluation.h"
#include "launch/run/flat_score.h"
#include "launch/run/run_progress.h"
#include "launch/run/stop_rule.h"
#include "launch/run/working_actors.h"

namespace shoal::launch {

enum class RunEnd { kTarget, kBudget, kInterrupted, kFailed };
// "target", "budget", "interrupted", "failed": the word in meta.json.
const char* ToString(RunEnd end);

class RunDecisions {
 public:
  // `config`: configuration with the present values. `before`: the counts of the run's earlier
  // sessions.
  RunDecisions(const Config& config, link::RunTopology topology, const RunMeta& before,
               SteadyTime start);

  // ---- Events. A returned line is for people; the caller prints the line.

  // Keys have new values (live_settings.h).
  void Change(const Config& config);
  void OnStopCommand() { stop_commanded_ = true; }
  // Marks the run as failed. Only the first reason is kept.
  std::optional<std::string> Fail(const std::string& why);
  // A progress message of a replay or of the learner has arrived.
  std::optional<std::string> OnReplay(const ReplayProgress& progress);
  void OnLearner(const LearnerProgress& progress) { progress_.OnLearner(progress); }
  void OnLearnerDeath() { progress_.OnLearnerDeath(); }
  // Gets the present state of the training actors and of the evaluation actor. Call several times a
  // second (liveness_timer.h).
  std::optional<std::string> OnStandings(const RoleStanding& actors, const RoleStanding& evaluation,
                                         SteadyTime now);
  // An earlier session of the run has counted this evaluation.
  void Recall(const EvaluationPoint& point) { Count(point); }
  struct Verdict {
    bool best = false;                   // the evaluation is the best so far
    std::optional<std::string> warning;  // a line if the results have stopped improving
  };
  // An evaluation of this session has arrived. Call in the order of arrival.
  Verdict OnEvaluation(const EvaluationPoint& point);
  // Begins the run's end. From now on the death of a process does not fail the run.
  std::optional<std::string> BeginEnd(RunEnd end);
  // Call when all processes have ended. The run has failed if its learner died after the budget was
  // used up and env steps were lost.
  std::optional<std::string> OnEnded();

  // ---- Decisions

  // Whether every process of the run has reported. Retired processes, and dead actors while other
  // actors work, need not have reported.
  bool Started(const std::function<bool(const ProcessName&)>& has_reported) const;
  // Whether keys may still be changed (live_settings.h).
  bool TakesCommands() const { return !end_ && !stop_commanded_; }
  // Reason why the run must end now; empty while the run continues. `interrupted`: a stop signal
  // arrived.
  std::optional<RunEnd> MustEnd(bool interrupted) const;
  // Whether the actors can store their remaining records: with a replay, only while a replay server
  // runs.
  bool CanDrain(int running_replays) const;
  // Whether the learner may stop after the actors have exited. If the budget ended the run, the
  // learner must first make the updates that the stored steps allow, and the last evaluation must
  // have arrived. In lockstep the same applies if the target ended the run, because a lockstep run
  // must always end the same way.
  bool Settled() const;
  // The argument of BeginEnd; empty before BeginEnd.
  std::optional<RunEnd> end() const { return end_; }
  // The end for meta.json: also kFailed if the run failed after BeginEnd.
  RunEnd FinalEnd() const;

  // ---- The run so far, with earlier sessions

  const RunProgress& progress() const { return progress_; }
  uint64_t env_steps() const;
  uint64_t updates() const { return progress_.updates().value_or(updates_before_); }
  const std::string& error() const { return error_; }  // the reason of a failure
  double target() const { return rule_.target(); }
  const std::optional<EvaluationPoint>& first_success() const { return rule_.first_success(); }
  const std::optional<EvaluationPoint>& last_evaluation() const { return last_evaluation_; }
  std::optional<EvaluationPoint> best() const;
  // Evaluations whose checkpoints are kept (best_evaluation.h).
  const std::vector<EvaluationPoint>& candidates() const { return bests_.candidates(); }

  // Number of training actors that are not down after a death.
  int ActorsWorking() const;
  // One line about actors that do not work; empty if all work.
  std::string Trouble() const { return DescribeTrouble(actors_, evaluation_actor_); }

 private:
  std::optional<std::string> Count(const EvaluationPoint& point);

  const link::RunTopology topology_;
  const uint64_t env_steps_before_, updates_before_;
  Config config_;
  StopRule rule_;
  RunProgress progress_;
  BestEvaluation bests_;
  FlatScore flat_;
  std::optional<EvaluationPoint> last_evaluation_;
  WorkingActors working_actors_;
  RoleStanding actors_, evaluation_actor_;  // of the last OnStandings
  bool stop_commanded_ = false;
  bool evaluated_ = false;  // an evaluation of this session arrived
  std::string error_;
  std::optional<RunEnd> end_;
};

}  // namespace shoal::launch
