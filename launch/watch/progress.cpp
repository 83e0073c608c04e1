#include "launch/watch/progress.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include "common/base/error.h"

namespace shoal::launch {
namespace {

constexpr std::chrono::milliseconds kBlockPeriod{500};
constexpr std::chrono::seconds kLinePeriod{5};
constexpr double kHeld = 0.05;  // share of time from which somebody counts as waiting

std::string Number(const std::optional<double>& value, const char* format = "{:.0f}") {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

std::string Percent(const std::optional<double>& value) {
  return value ? fmt::format("{:.0f} %", 100 * *value) : "-";
}

// Who waits for whom at the limiter.
std::string LimiterState(const ProgressFigures& f) {
  if (f.actors_wait.value_or(0) > kHeld) {
    return "actors wait for the learner " + Percent(f.actors_wait);
  }
  if (f.learner_waits.value_or(0) > kHeld) {
    return "learner waits for the actors " + Percent(f.learner_waits);
  }
  return f.actors_wait || f.learner_waits ? "nobody waits" : "-";
}

std::string Evaluation(const std::optional<EvaluationPoint>& e) {
  if (!e) return "none yet";
  return fmt::format("{} at {} env steps", FormatScore(*e), e->env_steps);
}

// Of the plain line: the rate alone, or the return where the task has no success.
std::string ShortScore(const std::optional<EvaluationPoint>& e) {
  if (!e) return "-";
  return e->success ? Percent(e->success) : fmt::format("return {:.2f}", e->mean_return);
}

// The headlines of the updates; "no update yet" before the first.
std::string Headlines(const ProgressFigures& f, std::string_view between) {
  std::string text;
  for (const auto& [name, value] : f.update_figures) {
    text += fmt::format("{}{} {:.4g}", text.empty() ? "" : between, name, value);
  }
  return text.empty() ? "no update yet" : text;
}

std::string Bar(double share, int width) {
  const int full = static_cast<int>(std::min(1.0, std::max(0.0, share)) * width);
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

std::optional<double> SecondsLeft(const ProgressFigures& f) {
  if (!f.env_steps_per_second || *f.env_steps_per_second <= 0) return std::nullopt;
  const uint64_t left = f.env_steps < f.budget ? f.budget - f.env_steps : 0;
  return static_cast<double>(left) / *f.env_steps_per_second;
}

std::string FormatProgressLine(const ProgressFigures& f) {
  return fmt::format(
      "{} {} | {}/{} env steps, {}/s | {} updates, {}/s | eval {} | {} | lag {} | {} | left {}",
      FormatDuration(f.elapsed_seconds), f.state, f.env_steps, f.budget,
      Number(f.env_steps_per_second), Number(f.updates), Number(f.updates_per_second, "{:.1f}"),
      ShortScore(f.last_evaluation), Headlines(f, " "), Number(f.policy_lag), LimiterState(f),
      FormatDuration(SecondsLeft(f)));
}

std::vector<std::string> FormatProgressBlock(const ProgressFigures& f, int width) {
  const double share =
      f.budget > 0 ? static_cast<double>(f.env_steps) / static_cast<double>(f.budget) : 0;
  std::vector<std::string> lines{
      fmt::format("{}  {}", f.run, f.state),
      fmt::format("  time       {} elapsed, {} left; {} processes, {} restarts",
                  FormatDuration(f.elapsed_seconds), FormatDuration(SecondsLeft(f)), f.processes,
                  f.restarts),
      fmt::format("  env steps  {} of {}  {:.0f} %  [{}]  {}/s", f.env_steps, f.budget, 100 * share,
                  Bar(share, 20), Number(f.env_steps_per_second)),
      fmt::format("  updates    {}  {}/s", Number(f.updates),
                  Number(f.updates_per_second, "{:.1f}")),
      fmt::format("  last eval  {}", Evaluation(f.last_evaluation)),
      fmt::format("  best       {}", Evaluation(f.best)),
      fmt::format("  actors     success {} in their last episodes", Percent(f.rollout_success)),
      fmt::format("  figures    {}", Headlines(f, "  ")),
      fmt::format("  age        policy lag {} updates, data {} updates old", Number(f.policy_lag),
                  Number(f.data_age)),
      fmt::format("  flow       {}", LimiterState(f)),
  };
  for (std::string& line : lines) line = CutToColumns(std::move(line), static_cast<size_t>(width));
  return lines;
}

Progress::Progress(const std::string& log_file, std::function<void(const std::string&)> on_say,
                   bool plain)
    : terminal_(!plain && DrawsInPlace()), on_say_(std::move(on_say)) {
  if (log_file.empty()) return;
  log_.open(log_file, std::ios::app);
  if (!log_) throw RuntimeError("cannot write '{}': {}", log_file, std::strerror(errno));
}

Progress::~Progress() { std::fflush(stdout); }

void Progress::Show(ProgressFigures figures, SteadyTime now) {
  if (shown_ && now - *shown_ < (terminal_ ? kBlockPeriod : SteadyTime::duration(kLinePeriod))) {
    return;
  }
  shown_ = now;
  const double seconds = figures.elapsed_seconds;
  if (const auto rate = env_steps_rate_.Add(seconds, static_cast<double>(figures.env_steps))) {
    figures.env_steps_per_second = rate;
  }
  if (figures.updates) {
    if (const auto rate = updates_rate_.Add(seconds, *figures.updates)) {
      figures.updates_per_second = rate;
    }
  }
  if (terminal_) {
    block_.Draw(FormatProgressBlock(figures, SizeOfTerminal().columns - 1));
  } else {
    std::printf("%s\n", FormatProgressLine(figures).c_str());
    std::fflush(stdout);
  }
}

void Progress::Say(const std::string& line) {
  block_.Erase();
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
  if (log_.is_open()) log_ << UtcTimestamp() << ' ' << line << std::endl;
  if (on_say_) on_say_(line);
}

}  // namespace shoal::launch
