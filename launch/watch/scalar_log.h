// SPDX-License-Identifier: Apache-2.0
// The run's TensorBoard scalars, x = env steps: training, rollouts and evaluations. The coordinator
// is the only process that writes them, so that TensorBoard follows one file per start of the run.
// The figures of the learner arrive in its reports.
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

// Writes to a new file in RUN/tensorboard. Each tag gets each step once, over all starts of the
// run: a point is left out if its tag already has a point at this step or a later one. One thread.
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

  // eval/mean_reward, eval/mean_ep_length, eval/success_rate.
  void WriteEvaluation(const EvaluationPoint& point);
  // rollout/ep_rew_mean, rollout/success_rate, rollout/ep_len_mean; every 5 s, starting with the
  // first finished episode.
  void WriteRollouts(const MetricsView& view, const ProgressFigures& figures, SteadyTime now);
  // Writes each figure of the updates under its tag (learner/agent/update_figures.h),
  // train/n_updates and time/fps, the mean since this session's first update. A report of the
  // learner is written if the learner has made updates since the report before. Reports of other
  // roles are ignored.
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
