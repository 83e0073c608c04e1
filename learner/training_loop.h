// SPDX-License-Identifier: Apache-2.0
// The learner's loop: batch, update, then weights, evaluation points, checkpoints and reports,
// until the run drains or stops.
//
// Checkpoints are written every learner.checkpoint_period updates, at each evaluation point, when
// draining is over (an evaluation point too) and at the end.
//
// Draining: the replay's limiter no longer withholds batches, so the learner itself stops. Draining
// ends when the learner has seen all records stored before draining, and has done the
// updates that samples_per_insert grants for them (in lockstep: the run's last update). It also
// ends kDrainIdle after the last batch, and at the latest after kDrainMost. On policy draining ends
// at once, because leaving actors do not complete rollouts.
//
// On policy, actors wait for the weights of each update, and at first for the initial weights. Once
// the budget is reached, actors get no more weights, unless the budget is raised.
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
#include "learner/sample_errors.h"
#include "learner/weights_sender.h"

namespace shoal::learner {

// Borrows what Parts refers to. One thread.
// Errors: Error (kNonFinite) if an update is not finite; Error if batches have another observation
// spec. Neither changes the checkpoints written before. A checkpoint that cannot be written is kept
// in memory and tried again (CheckpointStore); at the end the caller checks for unwritten
// checkpoints.
class TrainingLoop {
 public:
  struct Parts {
    RunConfig run;
    ProcessName name;  // name of this learner
    nn::Precision precision = nn::Precision::kF32;
    uint64_t session = 0;  // this learner's session: wall-clock ns at its start
    Agent& agent;          // fresh, or as in `restored`
    BatchStream& batches;
    LearnerSink& sink;
    CheckpointStore& checkpoints;
    PendingEvaluations& pending_evaluations;
    ControlState& control;
    UpdatePage& update_page;  // counts that survive a kill, for the next learner
    std::chrono::milliseconds drain_idle = kDrainIdle;
    int threads = 1;  // threads of the agent
    // Changes the agent's number of threads and returns the new number. If null, the agent keeps
    // `threads`. Called between updates, once for each requested number.
    std::function<int(int threads)> resize = nullptr;
    // Reads the use of the GPU; null or nullopt on a CPU.
    std::function<std::optional<CardUse>()> look = nullptr;
  };

  enum class End { kStopped, kCoordinatorLost };

  // `restored`: state of the checkpoint from which the agent was restored.
  TrainingLoop(const Parts& parts, const std::optional<CheckpointState>& restored);

  // Trains until kStopping, a stop signal, or the coordinator's death, and then writes a last
  // checkpoint.
  End Run();

  static constexpr std::chrono::milliseconds kDrainIdle{2'000};
  static constexpr std::chrono::seconds kDrainMost{30};

 private:
  // Waits briefly for a batch and trains with it. Returns false if none came.
  bool TryTrain();
  // Submits the batch to the agent and measures the time of the update's stages.
  std::vector<UpdateOutcome> Submit(const Batch& batch);
  // Waits for the updates in flight, and sends weights that were copied. Call it before anything
  // leaves the agent: weights for which actors wait, checkpoints, the state of a resized agent.
  // Throws Error if an update is not finite.
  void FinishUpdates();
  // Counts and reports updates whose outcomes are known. Throws Error if one is not finite.
  void OnOutcomes(const std::vector<UpdateOutcome>& outcomes);
  void AfterUpdate(const Batch& batch);
  void MakeEvaluationPoint();
  // Writes a checkpoint of the agent's current state, unless the newest checkpoint already
  // holds this state. Returns the checkpoint's name.
  std::string WriteCheckpoint();
  // Tries from time to time to write checkpoints that could not be written.
  void RetryCheckpoint(bool now = false);
  // Trains until draining is over, then makes the last evaluation point, once.
  void Drain();
  bool DrainingIsOver() const;
  // Batch elements that samples_per_insert grants for `env_steps` env steps: the integral of
  // samples_per_insert over env steps. If its value was changed, each value counts for the env
  // steps during which it was in force, as far as this process knows.
  double GrantedSamples(uint64_t env_steps) const;
  // Whether all granted updates are done. As in the replay's limiter, steps that are not sampleable
  // grant no updates.
  bool RatioReached() const;
  // On policy: sends the weights for which actors wait, once; not beyond the budget.
  void GiveAwaitedWeights();
  // Off policy: sends copied weights whose updates are finite, and begins to copy weights if they
  // are due after this update.
  void SendDueWeights();
  // Applies settings that were changed during the run.
  void ApplySettings();
  void ApplyThreads(int asked);
  // Reports progress, requested evaluations and the end of draining to the coordinator.
  void TellProgress();
  void Report(bool now = false);
  const char* State() const;

  const Parts parts_;
  const Config& config_;
  WeightsSender weights_;
  std::vector<EvaluationRequest> evaluations_asked_;  // the latest of this session
  EvaluationPoints evaluations_;
  LearnerReport report_;
  LearnerSeconds seconds_;
  const bool on_policy_, has_priorities_;
  SampleErrorCollector sample_errors_;     // unused without priorities
  uint64_t finite_updates_;                // updates that are known to be finite
  int threads_, threads_asked_;            // current number; number of the last request
  uint64_t budget_;                        // current budget, env steps
  std::optional<uint64_t> given_weights_;  // on policy: update of the weights sent last
  Schedule samples_per_insert_;            // current schedule
  double granted_before_ = 0;              // samples, up to granted_from_steps_
  uint64_t granted_from_steps_;            // env steps from which samples_per_insert_ counts
  uint64_t env_steps_ = 0;                 // stored at the draw of the last batch
  uint64_t unsampleable_steps_ = 0;        // part of env_steps_, as far as the replay knows
  uint64_t request_ = 0;                   // request of the last batch
  uint64_t checkpoints_written_ = 0;
  std::optional<uint64_t> checkpoint_of_;  // updates at which one was last requested
  SteadyTime waiting_since_;               // time of the last batch, or of the start
  std::optional<SteadyTime> drain_start_;
  int drain_batches_ = 0;  // batches used while draining
  bool drained_ = false, stopping_ = false, updating_ = false;
};

}  // namespace shoal::learner
