#include "launch/scalar_log.h"

#include <algorithm>
#include <string_view>

namespace shoal::launch {
namespace {

constexpr std::chrono::seconds kRolloutPeriod{5};

// Tags that people know, and what the learner calls these figures.
struct TrainingScalar {
  const char *tag, *metric;
};
constexpr TrainingScalar kTraining[] = {{"train/critic_loss", "critic_loss"},
                                        {"train/actor_loss", "actor_loss"},
                                        {"train/ent_coef", "temperature"},
                                        {"train/ent_coef_loss", "temperature_loss"},
                                        {"train/n_updates", "updates"}};

std::optional<double> Find(const MetricsMessage& report, std::string_view name) {
  const auto at = std::ranges::find(report.names, name);
  const auto i = static_cast<size_t>(at - report.names.begin());
  return i < report.values.size() ? std::optional(report.values[i]) : std::nullopt;
}

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
  if (rollouts_written_ && now - *rollouts_written_ < kRolloutPeriod) return;
  const auto write = [&](const char* tag, const std::optional<double>& value) {
    if (!value) return;
    writer_.Scalar(tag, static_cast<int64_t>(figures.env_steps), *value);
    rollouts_written_ = now;
  };
  write("rollout/ep_rew_mean", view.Mean("actor", "rollout_return", "episodes", now));
  write("rollout/success_rate", figures.rollout_success);
  write("rollout/ep_len_mean", view.Mean("actor", "rollout_length", "episodes", now));
  writer_.Flush();
}

void ScalarLog::WriteTraining(const MetricsMessage& report, SteadyTime now) {
  const auto updates = Find(report, "updates"), env_steps = Find(report, "env_steps");
  // Without a loss the process has made no update yet.
  if (report.role != "learner" || !updates || !env_steps || !Find(report, "critic_loss")) return;
  if (*updates == updates_written_) return;  // the figures are those of the report before
  updates_written_ = *updates;
  const auto x = static_cast<int64_t>(*env_steps);
  for (const TrainingScalar& scalar : kTraining) {
    if (const auto value = Find(report, scalar.metric)) writer_.Scalar(scalar.tag, x, *value);
  }
  if (!training_start_) training_start_ = {now, *env_steps};
  const double seconds = std::chrono::duration<double>(now - training_start_->time).count();
  const double steps = *env_steps - training_start_->env_steps;
  if (seconds > 0 && steps > 0) writer_.Scalar("time/fps", x, steps / seconds);
  writer_.Flush();
}

}  // namespace shoal::launch
