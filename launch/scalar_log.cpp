#include "launch/scalar_log.h"

namespace shoal::launch {
namespace {

constexpr std::chrono::seconds kPeriod{5};

}  // namespace

ScalarLog::ScalarLog(const std::filesystem::path& run) : writer_(run / "tensorboard") {}

void ScalarLog::WriteEvaluation(const EvaluationPoint& point) {
  const auto step = static_cast<int64_t>(point.env_steps);
  writer_.Scalar("eval/mean_reward", step, point.mean_return);
  if (point.success) writer_.Scalar("eval/success_rate", step, *point.success);
  writer_.Flush();
}

void ScalarLog::WriteRollouts(const MetricsView& view, const ProgressFigures& figures,
                              SteadyTime now) {
  if (written_ && now - *written_ < kPeriod) return;
  written_ = now;
  const auto write = [&](const char* tag, const std::optional<double>& value) {
    if (value) writer_.Scalar(tag, static_cast<int64_t>(figures.env_steps), *value);
  };
  write("rollout/ep_rew_mean", view.Mean("actor", "rollout_return", "episodes", now));
  write("rollout/success_rate", figures.rollout_success);
  write("rollout/ep_len_mean", view.Mean("actor", "rollout_length", "episodes", now));
  writer_.Flush();
}

}  // namespace shoal::launch
