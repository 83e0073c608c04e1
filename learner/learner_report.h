// SPDX-License-Identifier: Apache-2.0
// The learner's report of itself, once a second: metrics and warnings.
//
// Metrics (role "learner"); means over the last interval that had updates, unless stated otherwise:
//   updates, env_steps, warnings, and counters of weights, checkpoints, batches: totals
//   updates_per_second
//   the figures of the updates         named by the algorithm (agent/update_figures.h)
//   data_age_updates_p50, _p90, _p99  updates since the weights that chose the actions
//   seconds_STAGE, share_STAGE        use of the learner's time
//   eval_interval, budget_env_steps   current values
//   samples_per_insert, weights_period   current values, with a replay
//   threads                           current threads of the agent
//   card_memory_mb, card_memory_size_mb, card_busy   use of the GPU, if the learner has one
//   eval_updates                      updates of the last evaluation point sent
//   drained                           1 after the end of draining
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "common/config/run_config.h"
#include "common/wire/metrics_report.h"
#include "common/wire/process_name.h"
#include "learner/agent/agent.h"
#include "learner/batch_stream.h"
#include "learner/device/card_library.h"
#include "learner/training_guard.h"
#include "learner/update_window.h"

namespace shoal::learner {

// Use of the learner's time since its start, in seconds.
struct LearnerSeconds {
  double waiting = 0;              // waiting for batches
  std::array<double, 3> update{};  // by UpdateStage
  double weights = 0;              // publishing weights
  double checkpoint = 0;           // writing and syncing
};

struct LearnerFigures {
  const char* state = "starting";
  uint64_t updates = 0, env_steps = 0;
  uint64_t weights_sent = 0, weights_unsent = 0, evaluations_overtaken = 0;
  uint64_t checkpoints = 0;  // written
  size_t checkpoints_unwritten = 0;
  uint64_t eval_updates = 0;
  bool drained = false;
  double samples_per_insert = 0, eval_interval = 0, weights_period = 0;
  double budget = 0;            // env steps
  int threads = 1;              // threads of the agent
  std::optional<CardUse> card;  // use of the GPU
  LearnerSeconds seconds;
  BatchCounters batches;
};

// One thread.
class LearnerReport {
 public:
  LearnerReport(const ProcessName& name, const RunConfig& run);

  // Call for each batch when its update has begun. `updates`: number of updates with this one.
  void OnBatch(const Batch& batch, uint64_t updates);
  // Call when the update's figures are known. Updates are those of the batches in order.
  void OnUpdate(const UpdateFigures& figures);
  // Once a second.
  bool Due() { return report_.Due(Now()); }
  // Ends the interval: logs warnings and returns the metrics, valid until the next call.
  const MetricsMessage& Make(const LearnerFigures& figures);

 private:
  void AddTimes(const LearnerSeconds& seconds);
  void AddCard(const CardUse& card);
  void AddBatches(const LearnerFigures& figures);
  void AddRollouts(const BatchCounters::Rollouts& rollouts);

  const ObservationSpec spec_;
  const int shift_pad_;
  TrainingGuard guard_;
  MetricsReport report_;
  UpdateWindow window_;
  std::deque<UpdateFigures> batches_;  // figures of batches whose updates are not known yet
  int window_batches_ = 0;             // batches of the current interval
  UpdateFigures latest_;               // each figure's mean over the last interval that had it
  uint64_t updates_made_ = 0;          // by this process
  QuantileWindow data_ages_;
  Quantiles data_age_;  // of the last interval with updates
};

}  // namespace shoal::learner
