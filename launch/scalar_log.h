// TensorBoard scalars of evaluations and rollouts, x = env steps.
#pragma once

#include <filesystem>
#include <optional>

#include "common/tensorboard/event_writer.h"
#include "launch/metrics_view.h"
#include "launch/progress.h"
#include "launch/stop_rule.h"

namespace shoal::launch {

// Writes to RUN/tensorboard, beside the learner's file. One thread. Errors: Error on a full disk.
class ScalarLog {
 public:
  explicit ScalarLog(const std::filesystem::path& run);  // throws Error

  // eval/mean_reward, eval/success_rate.
  void WriteEvaluation(const EvaluationPoint& point);
  // rollout/ep_rew_mean, rollout/success_rate, rollout/ep_len_mean; every 5 s.
  void WriteRollouts(const MetricsView& view, const ProgressFigures& figures, SteadyTime now);

 private:
  tensorboard::EventWriter writer_;
  std::optional<SteadyTime> written_;
};

}  // namespace shoal::launch
