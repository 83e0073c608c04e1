// SPDX-License-Identifier: Apache-2.0
// The decisions of a run: whether it has started, when and why it ends, when its processes may
// stop, and which lines are due. Pure: figures, commands and times in, decisions out.
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
  // `config` has the live values. `before`: the counts of the run's earlier sessions.
  RunDecisions(const Config& config, link::RunTopology topology, const RunMeta& before,
               SteadyTime start);

  // ---- Events. A returned line is for people; print each once.

  // New values of live keys.
  void Change(const Config& config);
  void OnStopCommand() { stop_commanded_ = true; }
  // The run cannot continue. Only the first reason counts.
  std::optional<std::string> Fail(const std::string& why);
  // Progress of a replay, of the learner.
  std::optional<std::string> OnReplay(const ReplayProgress& progress);
  void OnLearner(const LearnerProgress& progress) { progress_.OnLearner(progress); }
  void OnLearnerDeath() { progress_.OnLearnerDeath(); }
  // The training actors and the evaluation actor now. Call several times a second
  // (liveness_timer.h).
  std::optional<std::string> OnStandings(const RoleStanding& actors, const RoleStanding& evaluation,
                                         SteadyTime now);
  // An evaluation that an earlier session of the run counted.
  void Recall(const EvaluationPoint& point) { Count(point); }
  struct Verdict {
    bool best = false;                   // of the evaluations so far
    std::optional<std::string> warning;  // the score has stopped improving
  };
  // An evaluation of this session, in the order of arrival.
  Verdict OnEvaluation(const EvaluationPoint& point);
  // Begins the run's end. From now on a dead process does not fail the run.
  std::optional<std::string> BeginEnd(RunEnd end);
  // All processes have ended. The run has failed if its learner died after the budget was used up
  // and lost env steps.
  std::optional<std::string> OnEnded();

  // ---- Decisions

  // Whether every process of the run has reported. A process that was retired, or that is dead
  // while other actors work, does not count.
  bool Started(const std::function<bool(const ProcessName&)>& has_reported) const;
  // Whether live keys may still change.
  bool TakesCommands() const { return !end_ && !stop_commanded_; }
  // Why the run must end now; empty while the run continues. `interrupted`: a stop signal arrived.
  std::optional<RunEnd> MustEnd(bool interrupted) const;
  // Whether the actors can store their remaining records: with a replay, only while a replay server
  // runs.
  bool CanDrain(int running_replays) const;
  // Whether the learner may stop, once the actors have left. If the budget ended the run, the
  // learner first makes the updates that the stored steps allow, and the last evaluation arrives.
  // In lockstep the same applies if the target ended the run, because the run must end the same way
  // each time.
  bool Settled() const;
  // The argument of BeginEnd; empty before.
  std::optional<RunEnd> end() const { return end_; }
  // The end for the record: a failure after BeginEnd counts as well.
  RunEnd FinalEnd() const;

  // ---- The run so far, earlier sessions included

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

  // Training actors that are not down after a death.
  int ActorsWorking() const;
  // One line about actors that do not work; empty when all work.
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
  RoleStanding actors_, evaluation_actor_;  // at the last look
  bool stop_commanded_ = false;
  bool evaluated_ = false;  // an evaluation of this session arrived
  std::string error_;
  std::optional<RunEnd> end_;
};

}  // namespace shoal::launch
