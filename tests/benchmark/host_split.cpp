// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/host_split.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "common/base/bounded_json.h"
#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::bench {
namespace {

using Json = nlohmann::json;

constexpr int kCores[] = {16, 32, 64, 128};
constexpr double kHostSamples[] = {2, 8, 16, 64};
constexpr const char* kNetwork = "compact";

std::map<int, double> TimesOne(std::string_view text, const std::string& source) {
  const Json file = ParseBoundedJson<Json>(text);
  if (!file.is_object() || file.value("schema", Json()) != "shoal-scaling-1") {
    throw RuntimeError("'{}' is no file of schema shoal-scaling-1", source);
  }
  std::map<int, std::vector<double>> efficiencies;
  for (const Json& row : file.at("rows")) {
    if (row.at("network") != kNetwork || row.at("batch") != kScaleBatch) continue;
    efficiencies[row.at("threads")].push_back(row.at("efficiency"));
  }
  std::map<int, double> times{{1, 1.0}};
  for (const auto& [threads, all] : efficiencies) {
    double sum = 0;
    for (const double efficiency : all) sum += efficiency;
    times[threads] = threads * sum / static_cast<double>(all.size());
  }
  return times;
}

// N and the share of N times one, from the row with most actors.
std::pair<double, int> KeptByActors(std::span<const Report> reports) {
  std::pair<double, int> kept{0, 0};
  for (const Report& report : reports) {
    for (const ReportedRow& row : report.rows) {
      int actors = 0, cores = 0, read = 0;
      const int fields = std::sscanf(
          row.stage.c_str(), "%d actors of FetchReach with one 84x84 camera, fast, on %d cores%n",
          &actors, &cores, &read);
      const bool whole = fields == 2 && static_cast<size_t>(read) == row.stage.size();
      if (whole && actors == cores && actors > kept.second) kept = {row.ratio.value(), actors};
    }
  }
  if (kept.second == 0) {
    throw RuntimeError("none of the files has a row of N actors of FetchReach on N cores");
  }
  return kept;
}

}  // namespace

LearnerSpeed::LearnerSpeed(std::string_view text, const std::string& source)
    : LearnerSpeed(TimesOne(text, source)) {}

LearnerSpeed::LearnerSpeed(std::map<int, double> times) : times_(std::move(times)) {
  CHECK(times_.contains(1)) << "the speed of one thread is missing";
}

double LearnerSpeed::Of(int threads) const {
  const auto above = times_.lower_bound(threads);
  const auto best =
      std::ranges::max_element(times_, {}, [](const auto& measured) { return measured.second; });
  if (above == times_.end() || threads >= best->first) return best->second;
  if (above->first == threads) return above->second;
  const auto below = std::prev(above);
  const double share = static_cast<double>(threads - below->first) / (above->first - below->first);
  return below->second + share * (above->second - below->second);
}

HostSplit BestSplit(const ScaleConstants& constants, const LearnerSpeed& speed, double kept,
                    int cores, double samples_per_insert) {
  CHECK(cores >= 2) << cores << " cores";
  const double replay = LoadOf(constants, 1, samples_per_insert, /*far=*/false).replay;
  const double actor = constants.actor_rate * kept;
  HostSplit best;
  for (int threads = 1; threads < cores; ++threads) {
    // Actors use the remaining cores, minus the replay server's share per env step.
    const double made = (cores - threads) * actor / (1 + actor * replay);
    const double learned =
        kScaleBatch * speed.Of(threads) / (constants.update * samples_per_insert);
    const double rate = std::min(made, learned);
    if (rate <= best.env_steps_per_second) continue;
    best = {.learner_threads = threads,
            .actor_cores = rate / actor,
            .replay_cores = rate * replay,
            .env_steps_per_second = rate};
  }
  return best;
}

std::string HostTable(std::span<const Report> reports, const LearnerSpeed& speed) {
  const ScaleConstants constants = ReadScaleConstants(reports);
  const auto [kept, actors] = KeptByActors(reports);
  std::string text = fmt::format(
      "{} actors on {} cores make {:.2f} of {} times the env steps per second of one actor.\n\n"
      "| cores of the host | samples per insert | learner threads | cores of the actors | "
      "cores of the replay server | idle cores | env steps/s |\n| --- | --- | --- | --- | --- | "
      "--- | --- |\n",
      actors, actors, kept, actors);
  for (const int cores : kCores) {
    for (const double samples : kHostSamples) {
      const HostSplit split = BestSplit(constants, speed, kept, cores, samples);
      const double idle =
          std::max(0.0, cores - split.learner_threads - split.actor_cores - split.replay_cores);
      text += fmt::format("| {} | {:.0f} | {} | {:.1f} | {:.1f} | {:.1f} | {:.0f} |\n", cores,
                          samples, split.learner_threads, split.actor_cores, split.replay_cores,
                          idle, split.env_steps_per_second);
    }
  }
  return text;
}

}  // namespace shoal::bench
