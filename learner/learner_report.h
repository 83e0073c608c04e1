// What the learner tells about itself once a second: metrics, TensorBoard scalars, warnings.
//
// Metrics (role "learner", id 0), means over the last interval with updates in it unless said
// otherwise:
//   updates, env_steps, warnings, and counters of weights, checkpoints, batches: totals
//   updates_per_second, critic_loss, actor_loss, temperature, temperature_loss, q_mean,
//   target_mean, entropy, action_saturation, critic_grad_norm, actor_grad_norm policy_lag_p50,
//   policy_lag_p95    updates, of the last batch seconds_waiting, seconds_update, seconds_publish,
//   seconds_checkpoint    since the start; the
//                                     growth per second is the share of the learner's time
//   eval_updates                      updates of the last evaluation point handed out
//   drained                           1 once draining is over
#pragma once

#include <cstdint>
#include <string>

#include "common/config/run_files.h"
#include "common/tensorboard/event_writer.h"
#include "common/wire/metrics_report.h"
#include "learner/batch_stream.h"
#include "learner/training_guard.h"
#include "learner/update_window.h"

namespace shoal::learner {

// Where the learner's seconds went since its start.
struct LearnerSeconds {
  double waiting = 0;  // for batches
  double update = 0;
  double publish = 0;     // weights
  double checkpoint = 0;  // writing and syncing
};

struct LearnerFigures {
  const char* state = "starting";
  uint64_t updates = 0, env_steps = 0;
  uint64_t weights_sent = 0, weights_unsent = 0, evaluations_overtaken = 0;
  uint64_t checkpoints = 0;  // written
  uint64_t eval_updates = 0;
  bool drained = false;
  LearnerSeconds seconds;
  BatchCounters batches;
};

// Borrows the event writer. One thread.
class LearnerReport {
 public:
  LearnerReport(const RunConfig& run, tensorboard::EventWriter& events);

  void OnUpdate(const UpdateStats& stats, const Batch& batch, uint64_t updates);
  // Once a second.
  bool Due() { return report_.Due(Now()); }
  // Ends the interval: logs warnings, writes scalars, and returns the metrics, valid until the next
  // call. Throws Error when the event file cannot be written.
  const MetricsMessage& Make(const LearnerFigures& figures);

 private:
  void AddUpdateFigures();
  void WriteScalars(const LearnerFigures& figures);

  tensorboard::EventWriter& events_;
  TrainingGuard guard_;
  MetricsReport report_;
  SteadyTime last_made_;
  UpdateWindow window_;
  UpdateStats mean_;  // of the last interval with updates
  bool any_updates_ = false;
  PolicyLag policy_lag_;
  SteadyTime first_update_{};
  uint64_t first_env_steps_ = 0;  // stored then
};

}  // namespace shoal::learner
