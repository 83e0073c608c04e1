// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/scalar_log.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "common/config/config_io.h"
#include "common/run_folder/run_file_names.h"
#include "common/tensorboard/last_steps.h"
#include "learner/agent/algorithms.h"

namespace shoal::launch {
namespace {

constexpr std::chrono::seconds kRolloutPeriod{5};

std::optional<double> FindScalar(const MetricsMessage& report, std::string_view name) {
  const auto at = std::ranges::find(report.names, name);
  const auto i = static_cast<size_t>(at - report.names.begin());
  return i < report.values.size() ? std::optional(report.values[i]) : std::nullopt;
}

// Lists and maps are written as JSON text.
tensorboard::HyperParameter ToHyperParameter(const nlohmann::ordered_json& value) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number()) return value.get<double>();
  return value.is_string() ? value.get<std::string>() : value.dump();
}

using Settings = std::vector<std::pair<std::string, nlohmann::ordered_json>>;

// Every key by its dotted name.
Settings SettingsOf(const Config& config) {
  Settings settings;
  const nlohmann::ordered_json sections = ToJson(config);
  for (const auto& [name, value] : sections.items()) {
    if (!value.is_object()) {
      settings.emplace_back(name, value);
      continue;
    }
    for (const auto& [inner, of_section] : value.items()) {
      settings.emplace_back(name + "." + inner, of_section);
    }
  }
  return settings;
}

}  // namespace

ScalarLog::ScalarLog(const std::filesystem::path& run)
    : last_steps_(tensorboard::LastSteps(run / kTensorBoardFolder)),
      writer_(run / kTensorBoardFolder) {}

void ScalarLog::Scalar(const std::string& tag, int64_t step, double value) {
  const auto [it, added] = last_steps_.try_emplace(tag, step);
  if (!added && step <= it->second) return;
  it->second = step;
  writer_.Scalar(tag, step, value);
}

void ScalarLog::WriteConfig(const Config& config) {
  std::map<std::string, tensorboard::HyperParameter> settings;
  std::string table = "| key | value |\n| --- | --- |\n";
  for (const auto& [key, value] : SettingsOf(config)) {
    settings[key] = ToHyperParameter(value);
    table += fmt::format("| {} | {} |\n", key,
                         value.is_string() ? value.get<std::string>() : value.dump());
  }
  writer_.Text("configuration", table);
  writer_.BeginSession(settings);
}

void ScalarLog::WriteEnd(bool success) { writer_.EndSession(success); }

void ScalarLog::WriteEvaluation(const EvaluationPoint& point) {
  const auto step = static_cast<int64_t>(point.env_steps);
  Scalar("eval/mean_reward", step, point.mean_return);
  Scalar("eval/mean_ep_length", step, point.mean_length);
  if (point.success) Scalar("eval/success_rate", step, *point.success);
}

void ScalarLog::WriteRollouts(const MetricsView& view, const ProgressFigures& figures,
                              SteadyTime now) {
  if (rollouts_written_ && now - *rollouts_written_ < kRolloutPeriod) return;
  const auto write = [&](const char* tag, const std::optional<double>& value) {
    if (!value) return;
    Scalar(tag, static_cast<int64_t>(figures.env_steps), *value);
    rollouts_written_ = now;
  };
  write("rollout/ep_rew_mean", view.Mean("actor", "rollout_return", "episodes", now));
  write("rollout/success_rate", figures.rollout_success);
  write("rollout/ep_len_mean", view.Mean("actor", "rollout_length", "episodes", now));
}

void ScalarLog::WriteTraining(const MetricsMessage& report, SteadyTime now) {
  const auto updates = FindScalar(report, "updates"), env_steps = FindScalar(report, "env_steps");
  if (report.role != "learner" || !updates || !env_steps) return;
  const auto x = static_cast<int64_t>(*env_steps);
  bool any = false;
  for (size_t i = 0; i < report.names.size() && i < report.values.size(); ++i) {
    const learner::Figure* figure = learner::FindFigure(report.names[i]);
    if (figure == nullptr) continue;
    if (*updates == updates_written_) return;  // no update since the last report
    Scalar(figure->Tag(), x, report.values[i]);
    any = true;
  }
  if (!any) return;  // the process has made no update yet
  updates_written_ = *updates;
  Scalar("train/n_updates", x, *updates);
  if (!training_start_) training_start_ = {now, *env_steps};
  const double seconds = std::chrono::duration<double>(now - training_start_->time).count();
  const double steps = *env_steps - training_start_->env_steps;
  if (seconds > 0 && steps > 0) Scalar("time/fps", x, steps / seconds);
}

}  // namespace shoal::launch
