// SPDX-License-Identifier: Apache-2.0
// The run's TensorBoard scalars, x = env steps: training, rollouts and evaluations. Only the
// coordinator writes the scalars, so that TensorBoard follows one file per start of the run. The
// learner's metrics arrive in its reports.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "common/config/config.h"
#include "common/tensorboard/event_writer.h"
#include "launch/record/evaluation_point.h"
#include "launch/watch/metrics_view.h"
#include "launch/watch/progress.h"

namespace shoal::launch {

// Writes to a new file in RUN/tensorboard. Over all starts of the run, each tag has at most one
// point per step: a point is left out if its tag already has a point at this step or at a later
// step. One thread.
class ScalarLog {
 public:
  explicit ScalarLog(const std::filesystem::path& run);  // throws Error

  // Writes the points added since the last call. Throws Error if writing fails; the points are then
  // kept for the next call.
  void Flush() { writer_.Flush(); }

  // Writes all keys for TensorBoard's text tab and hparams tab.
  void WriteConfig(const Config& config);
  // Writes the run's end for the hparams tab.
  void WriteEnd(bool success);

  // Writes eval/mean_reward, eval/mean_ep_length, eval/success_rate.
  void WriteEvaluation(const EvaluationPoint& point);
  // Writes rollout/ep_rew_mean, rollout/success_rate, rollout/ep_len_mean every 5 s, starting with
  // the first finished episode.
  void WriteRollouts(const MetricsView& view, const ProgressFigures& figures, SteadyTime now);
  // Writes each metric of the updates under its tag (learner/agent/update_figures.h),
  // train/n_updates, and time/fps (mean since this session's first update). A report of the learner
  // is written if the learner has made updates since its previous report. Reports of other roles
  // are ignored.
  void WriteTraining(const MetricsMessage& report, SteadyTime now);

 private:
  // Time and env steps at which the count for time/fps begins.
  struct Start {
    SteadyTime time;
    double env_steps = 0;
  };

  void Scalar(const std::string& tag, int64_t step, double value);

  std::map<std::string, int64_t> last_steps_;  // by tag
  tensorboard::EventWriter writer_;
  std::optional<SteadyTime> rollouts_written_;
  double updates_written_ = 0;
  std::optional<Start> training_start_;
};

}  // namespace shoal::launch
