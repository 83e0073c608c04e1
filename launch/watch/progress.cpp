// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/progress.h"

#include <fcntl.h>
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "common/base/files.h"

namespace shoal::launch {
namespace {

constexpr std::chrono::milliseconds kBlockPeriod{500};
constexpr std::chrono::seconds kLinePeriod{5};
constexpr double kShownAsWaiting = 0.05;  // share of time from which a role counts as waiting

std::string NumberText(const std::optional<double>& value, const char* format = "{:.0f}") {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

std::string Percent(const std::optional<double>& value) {
  return value ? fmt::format("{:.0f} %", 100 * *value) : "-";
}

// The side that the limiter holds back.
std::string LimiterState(const ProgressFigures& f) {
  if (f.actors_wait.value_or(0) > kShownAsWaiting) {
    return "actors wait for the learner " + Percent(f.actors_wait);
  }
  if (f.learner_waits.value_or(0) > kShownAsWaiting) {
    return "learner waits for the actors " + Percent(f.learner_waits);
  }
  return f.actors_wait || f.learner_waits ? "neither side waits" : "-";
}

std::string Evaluation(const std::optional<EvaluationPoint>& e) {
  return e ? fmt::format("at {}: {}", e->env_steps, FormatScore(*e)) : "none yet";
}

// Score for the plain line: the success rate, or return and length if the task has no success.
std::string ShortScore(const std::optional<double>& success, const std::optional<double>& mean,
                       const std::optional<double>& length) {
  if (success) return Percent(success);
  if (!mean) return "-";
  return fmt::format("return {:.2f}", *mean) +
         (length.value_or(0) > 0 ? fmt::format(" length {:.0f}", *length) : "");
}

std::string ShortScore(const std::optional<EvaluationPoint>& e) {
  return e ? ShortScore(e->success, e->mean_return, e->mean_length) : "-";
}

// Text of the actors' episodes for the block.
std::string Rollouts(const ProgressFigures& f) {
  if (!f.rollout_return) return "no episode has ended yet";
  const std::string success =
      f.rollout_success ? "success " + Percent(f.rollout_success) + ", " : "";
  return fmt::format("{}return {:.3f}, length {}; their last 100 episodes", success,
                     *f.rollout_return, NumberText(f.rollout_length));
}

std::string FaultyEpisodes(const ProgressFigures& f, std::string_view before) {
  if (f.faulty_episodes == 0) return "";
  return fmt::format("{}{} faulty episodes", before, f.faulty_episodes);
}

// "2500/10000 env steps". A run can exceed its budget, for example after `shoal set env_steps`.
std::string StepsOfBudget(const ProgressFigures& f) {
  if (f.env_steps > f.budget) return fmt::format("{} env steps (budget {})", f.env_steps, f.budget);
  return fmt::format("{}/{} env steps", f.env_steps, f.budget);
}

// The main figures of the updates; "no update yet" before the first update.
std::string Headlines(const ProgressFigures& f, std::string_view between) {
  std::string text;
  for (const auto& [name, value] : f.update_figures) {
    text += fmt::format("{}{} {:.4g}", text.empty() ? "" : between, name, value);
  }
  return text.empty() ? "no update yet" : text;
}

std::string Bar(double share, int width) {
  const int full = static_cast<int>(share * width);
  return std::string(static_cast<size_t>(full), '#') +
         std::string(static_cast<size_t>(width - full), '.');
}

}  // namespace

std::string FormatDuration(std::optional<double> seconds) {
  if (!seconds || !(*seconds >= 0) || *seconds > 1e9) return "-";
  const auto whole = static_cast<int64_t>(*seconds);
  const int64_t hours = whole / 3600, minutes = whole / 60 % 60;
  if (hours > 0) return fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60);
  return fmt::format("{:02}:{:02}", minutes, whole % 60);
}

std::string FormatProgressLine(const ProgressFigures& f) {
  const std::string line = fmt::format(
      "{} {} | {}, {}/s | {} updates, {}/s | eval {} | actors {} | {} | lag {} | {}{} | left {}",
      FormatDuration(f.elapsed_seconds), f.state, StepsOfBudget(f),
      NumberText(f.env_steps_per_second), NumberText(f.updates),
      NumberText(f.updates_per_second, "{:.1f}"), ShortScore(f.last_evaluation),
      ShortScore(f.rollout_success, f.rollout_return, f.rollout_length), Headlines(f, " "),
      NumberText(f.policy_lag), LimiterState(f), FaultyEpisodes(f, " | "),
      FormatDuration(f.seconds_left));
  return f.trouble.empty() ? line : line + " | " + f.trouble;
}

std::vector<std::string> FormatProgressBlock(const ProgressFigures& f, int width) {
  const double share =
      f.budget > 0 ? std::min(1.0, static_cast<double>(f.env_steps) / static_cast<double>(f.budget))
                   : 0;
  std::vector<std::string> lines{
      fmt::format("{}  {}", f.run, f.state),
      fmt::format("  time       {} elapsed, {} left; {} processes, {} restarts",
                  FormatDuration(f.elapsed_seconds), FormatDuration(f.seconds_left), f.processes,
                  f.restarts),
      fmt::format("  env steps  {} of {}  {:.0f} %  [{}]  {}/s", f.env_steps, f.budget, 100 * share,
                  Bar(share, 20), NumberText(f.env_steps_per_second)),
      fmt::format("  updates    {}  {}/s", NumberText(f.updates),
                  NumberText(f.updates_per_second, "{:.1f}")),
      fmt::format("  last eval  {}", Evaluation(f.last_evaluation)),
      fmt::format("  best       {}", Evaluation(f.best)),
      fmt::format("  actors     {}{}", Rollouts(f), FaultyEpisodes(f, "; ")),
      fmt::format("  figures    {}", Headlines(f, "  ")),
      fmt::format("  age        policy lag {} updates, data {} updates old",
                  NumberText(f.policy_lag), NumberText(f.data_age)),
      fmt::format("  flow       {}", LimiterState(f)),
  };
  if (!f.trouble.empty()) lines.push_back("  trouble    " + f.trouble);
  for (std::string& line : lines) line = CutToColumns(std::move(line), static_cast<size_t>(width));
  return lines;
}

Progress::Progress(const std::string& log_file, std::function<void(const std::string&)> on_say,
                   bool plain)
    : terminal_(!plain && DrawsInPlace()), on_say_(std::move(on_say)) {
  if (log_file.empty()) return;
  OpenRegular(log_file, O_WRONLY | O_CREAT | O_APPEND);  // throws if the log cannot be written
  log_.open(log_file, std::ios::app);
}

Progress::~Progress() {
  if (terminal_) block_.Leave();
  std::fflush(stdout);
}

void Progress::Show(const ProgressFigures& figures, SteadyTime now) {
  if (shown_ && now - *shown_ < (terminal_ ? kBlockPeriod : SteadyTime::duration(kLinePeriod))) {
    return;
  }
  if (terminal_ && !InForeground()) return;
  shown_ = now;
  if (terminal_) {
    block_.Draw(FormatProgressBlock(figures, SizeOfTerminal().columns - 1));
  } else {
    std::printf("%s\n", FormatProgressLine(figures).c_str());
    std::fflush(stdout);
  }
}

void Progress::Say(const std::string& line) {
  if (terminal_) block_.Erase();
  for (const std::string& row : LinesOnTerminal(line)) std::printf("%s\n", row.c_str());
  std::fflush(stdout);
  if (log_.is_open()) {
    log_.clear();  // retry after a failed write: the disk may have room again
    log_ << UtcTimestamp() << ' ' << line << std::endl;
  }
  if (on_say_) on_say_(line);
}

}  // namespace shoal::launch
