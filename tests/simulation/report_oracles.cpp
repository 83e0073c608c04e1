// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/report_oracles.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "common/run_folder/run_file_names.h"

namespace shoal::simulation {
namespace {

using nlohmann::json;

// Calls `look` for each report of the role while it was running.
void ForEachReport(const std::filesystem::path& run, const std::string& role,
                   const std::function<void(const json& report)>& look) {
  std::ifstream lines(run / kMetricsFile);
  const std::string mark = fmt::format("\"role\":\"{}\"", role);
  for (std::string line; std::getline(lines, line);) {
    if (line.find(mark) == std::string::npos) continue;  // parsing costs more
    const json report = json::parse(line, nullptr, /*allow_exceptions=*/false);
    if (!report.is_discarded() && report.value("state", "") == "running") look(report);
  }
}

double Number(const json& report, const char* name) { return report.at(name).get<double>(); }

// The limiter's cursor, computed from the counts of steps and samples, because the limiter's own
// cursor is clamped to its band.
class CountedCursor {
 public:
  explicit CountedCursor(const Config& config)
      : min_size_(static_cast<double>(config.replay.min_size)) {}

  // One line when the cursor has left the band.
  std::optional<std::string> Take(const json& report) {
    const double sampleable = Number(report, "sampleable"), stored = Number(report, "stored_steps");
    const double rate = Number(report, "limiter_samples_per_insert");
    const double start = Number(report, "t") - Number(report, "uptime_seconds");
    // Else another server: the clock may be set back so that both seem to have started together.
    const double uptime = Number(report, "uptime_seconds");
    const double uptime_before = std::exchange(uptime_, uptime);
    const bool follows = std::abs(start - start_) < kSameStart && uptime >= uptime_before;
    if (!follows) uncounted_ = stored;
    // A lower rate has a narrower band, but credit that was given before the change stays, also
    // where the clock has jumped so that the same server does not seem to follow.
    constant_rate_ = uptime < uptime_before || (constant_rate_ && rate == rate_);
    if (sampleable < min_size_) uncounted_ = stored + min_size_ - sampleable;
    const double granted = rate * std::max(0., stored - uncounted_);
    const double sampled = Number(report, "sampled");
    cursor_ = follows ? cursor_ + (granted - granted_) - (sampled - sampled_)
                      : Number(report, "limiter_cursor");
    granted_ = granted;
    sampled_ = sampled;
    rate_ = rate;
    start_ = start;
    const double band = Number(report, "limiter_band");
    if (!constant_rate_ || std::abs(cursor_) <= band / 2 + 1e-3) return std::nullopt;
    return fmt::format("the limiter's cursor is {} in a band of {}", cursor_, band);
  }

 private:
  static constexpr double kSameStart = 0.5;  // s

  const double min_size_;
  bool constant_rate_ = true;
  double uncounted_ = 0;  // env steps that are not counted
  double cursor_ = 0, granted_ = 0, sampled_ = 0, rate_ = 0, start_ = 0;
  double uptime_ = std::numeric_limits<double>::infinity();
};

// One line if the learner dropped a rollout that was not late, while no actor and no learner was
// restarted.
std::optional<std::string> DroppedRollouts(const World& world, const Facts& facts) {
  std::optional<std::string> broken;
  bool orderly = true;
  double last = facts.orderly_from;
  ForEachReport(world.folder, "learner", [&](const json& report) {
    const double time = Number(report, "t");
    orderly = orderly && time < facts.orderly_until && time >= last;  // the clock may jump back
    last = time;
    if (broken || !orderly || !report.contains("rollouts_dropped")) return;
    const double dropped = Number(report, "rollouts_dropped");
    if (dropped == 0 || Number(report, "rollouts_late") > 0) return;
    broken = fmt::format("{} rollouts were dropped, none of them late", dropped);
  });
  return broken;
}

}  // namespace

std::vector<std::string> BrokenInReports(const World& world, const Facts& facts) {
  std::vector<std::string> broken;
  // Without a ring, a successor counts on from the account, which a failing disk keeps as it was.
  const bool memory = world.blueprint.run.config.replay.storage == "memory";
  const bool forgets = facts.unwritten && (memory || facts.lost);
  CountedCursor cursor(world.blueprint.run.config);
  double stored = 0;
  ForEachReport(world.folder, "replay", [&](const json& report) {
    if (!broken.empty()) return;
    if (auto line = cursor.Take(report)) broken.push_back(*std::move(line));
    const double steps = Number(report, "stored_steps");
    if (steps < stored && !facts.cut && !forgets) {
      broken.push_back(fmt::format("the replay counts {} env steps after {}", steps, stored));
    }
    stored = steps;
  });
  if (auto line = DroppedRollouts(world, facts)) broken.push_back(*std::move(line));
  return broken;
}

}  // namespace shoal::simulation
