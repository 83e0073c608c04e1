// SPDX-License-Identifier: Apache-2.0
// The learner's loop: batch, update, and what follows from it (weights, evaluation points,
// checkpoints, reports), until the run drains or stops.
//
// Checkpoints are written every learner.checkpoint_period updates, at each evaluation point, when
// draining is over (an evaluation point too) and at the end.
//
// Draining: the replay no longer holds batches back, so the learner itself stops, once it has seen
// what was stored when draining began and has done the updates that samples_per_insert grants for
// it (in lockstep: the run's last update). It is over as well kDrainIdle after the last batch, and
// after kDrainMost. On policy it is over at once: what actors send while they leave is no whole
// rollout.
//
// On policy actors wait for the weights of each update, those of none before the first included;
// once the budget is reached they get no more, unless it is raised.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/config/run_config.h"
#include "common/run_folder/update_page.h"
#include "common/wire/control_state.h"
#include "learner/agent/agent.h"
#include "learner/batch_stream.h"
#include "learner/checkpoint_store.h"
#include "learner/evaluation_points.h"
#include "learner/learner_report.h"
#include "learner/learner_sink.h"
#include "learner/pending_evaluations.h"
#include "learner/weights_sender.h"

namespace shoal::learner {

// Borrows what Parts refers to. One thread.
// Errors: Error (kNonFinite) when an update is not finite; Error when batches are of another spec;
// the checkpoints written before stay as they are. A checkpoint that cannot be written is kept and
// tried again (CheckpointStore): at the end the caller asks for what is still unwritten.
class TrainingLoop {
 public:
  struct Parts {
    RunConfig run;
    ProcessName name;  // this learner's
    nn::Precision precision = nn::Precision::kF32;
    uint64_t session = 0;  // this learner's: wall-clock ns at its start
    Agent& agent;          // fresh, or as in `restored`
    BatchStream& batches;
    LearnerSink& sink;
    CheckpointStore& checkpoints;
    PendingEvaluations& pending_evaluations;
    ControlState& control;
    UpdatePage& update_page;  // counts for the successor after a kill
    std::chrono::milliseconds drain_idle = kDrainIdle;
    int threads = 1;  // the agent's
    // Gives the agent another number of threads; returns its number from now on. Null: it keeps
    // `threads`. Called between updates, once for each number that is asked for.
    std::function<int(int threads)> resize = nullptr;
  };

  enum class End { kStopped, kCoordinatorLost };

  // `restored`: the state of the checkpoint that the agent was restored from.
  TrainingLoop(const Parts& parts, const std::optional<CheckpointState>& restored);

  // Until kStopping, a stop signal, or the coordinator's death; a last checkpoint is then written.
  End Run();

  static constexpr std::chrono::milliseconds kDrainIdle{2'000};
  static constexpr std::chrono::seconds kDrainMost{30};

 private:
  // Waits a moment for a batch and uses it. False: none came.
  bool TryTrain();
  // The agent's update, its stages timed.
  UpdateOutcome Update(const BatchView& batch);
  void AfterUpdate(const Batch& batch, const UpdateFigures& figures);
  void MakeEvaluationPoint();
  // Writes a checkpoint of the agent as it is, unless the newest one is that. Returns its name.
  std::string WriteCheckpoint();
  // Writes what could not be written, once in a while.
  void RetryCheckpoint(bool now = false);
  // Draining: goes on training until it is over, then makes the last evaluation point, once.
  void Drain();
  bool DrainingIsOver() const;
  // Batch elements that samples_per_insert grants for so many env steps: its integral over them, of
  // each value set meanwhile for the steps it was in force for, as far as this process knows.
  double GrantedSamples(uint64_t env_steps) const;
  // Whether the updates done are those granted. Steps that no sample begins with grant none, as in
  // the replay's limiter.
  bool RatioReached() const;
  // On policy: the weights that actors wait for, once; not beyond the budget.
  void GiveAwaitedWeights();
  // Takes over what was changed while the run goes on.
  void ApplySettings();
  void ApplyThreads(int asked);
  // To the coordinator: what the run is decided by.
  void TellProgress();
  void Report(bool now = false);
  const char* State() const;

  const Parts parts_;
  const Config& config_;
  WeightsSender weights_;
  std::vector<EvaluationRequest> evaluations_asked_;  // of this session, the last ones
  EvaluationPoints evaluations_;
  LearnerReport report_;
  LearnerSeconds seconds_;
  const bool on_policy_;
  int threads_, threads_asked_;            // of the agent; of the order obeyed last
  uint64_t budget_;                        // env steps, in force
  std::optional<uint64_t> given_weights_;  // on policy: the update of those given last
  Schedule samples_per_insert_;            // in force
  double granted_before_ = 0;              // samples, up to granted_from_steps_
  uint64_t granted_from_steps_;            // env steps from which samples_per_insert_ counts
  uint64_t env_steps_ = 0;                 // stored when the last batch was drawn
  uint64_t unsampleable_steps_ = 0;        // of these, as far as the replay knows
  uint64_t request_ = 0;                   // of that batch
  uint64_t checkpoints_written_ = 0;
  std::optional<uint64_t> checkpoint_of_;  // updates at which one was asked for last
  SteadyTime waiting_since_;               // the last batch, or the start
  std::optional<SteadyTime> drain_start_;
  int drain_batches_ = 0;  // used while draining
  bool drained_ = false, stopping_ = false, updating_ = false;
};

}  // namespace shoal::learner
