// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/bottleneck.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "common/base/files.h"
#include "common/run_folder/run_file_names.h"
#include "launch/watch/advice.h"

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;

constexpr double kLeastShown = 0.005;

// Stages that run on a separate thread, in parallel to the other stages.
constexpr std::string_view kBeside[] = {"sending"};

// A stage is counted when it ends, so the seconds of a long stage may exceed the observed period.
double ShareOf(double seconds, double of) { return std::min(1.0, seconds / of); }

// `run_seconds`: length of the observed period.
ProcessTimes TimesOf(const std::string& role, const RoleTotals& totals, double run_seconds) {
  ProcessTimes times{.role = role, .processes = totals.processes, .seconds = totals.seconds};
  double named = 0;
  for (const auto& [stage, seconds] : totals.stages) {
    const double share = ShareOf(seconds, totals.seconds);
    if (share < kLeastShown) continue;
    times.stages.push_back({stage, share});
    if (std::ranges::find(kBeside, stage) == std::end(kBeside)) named += share;
  }
  if (1 - named >= kLeastShown) times.stages.push_back({std::string(kOtherStage), 1 - named});
  std::ranges::stable_sort(times.stages, std::ranges::greater(), &StageShare::share);
  times.cores = totals.cpu_seconds / run_seconds;
  return times;
}

// Length of the observed period. Replay server and learner exist for the whole run, actors may not.
double RunSeconds(const RunTotals& totals, const RoleTotals& role) {
  for (const char* server : {"replay", "learner"}) {
    if (const auto it = totals.find(server); it != totals.end()) return it->second.seconds;
  }
  return role.seconds;
}

}  // namespace

Bottleneck FindBottleneck(const RunTotals& totals, const RunResources& resources) {
  Bottleneck result{.usable = resources.usable_cores};
  for (const std::string_view role : kCountedRoles) {
    const auto of_role = totals.find(role);
    if (of_role == totals.end()) continue;
    const double run_seconds = RunSeconds(totals, of_role->second);
    result.seconds = std::max(result.seconds, run_seconds);
    result.roles.push_back(TimesOf(of_role->first, of_role->second, run_seconds));
    result.cores += result.roles.back().cores;
  }
  const auto replay = totals.find("replay");
  result.limited = replay != totals.end();
  if (result.limited) {
    result.inserts_blocked = ShareOf(replay->second.inserts_blocked, replay->second.seconds);
    result.samples_blocked = ShareOf(replay->second.samples_blocked, replay->second.seconds);
  }
  result.advice = Advise(result, resources);
  return result;
}

std::string WordsOf(std::string stage) {
  std::ranges::replace(stage, '_', ' ');
  return stage;
}

double ShareOf(const Bottleneck& figures, std::string_view role, std::string_view stage) {
  for (const ProcessTimes& times : figures.roles) {
    if (times.role != role) continue;
    for (const StageShare& share : times.stages) {
      if (share.stage == stage) return share.share;
    }
  }
  return 0;
}

std::vector<std::string> FormatBottleneck(const Bottleneck& bottleneck) {
  std::vector<std::string> lines;
  for (const ProcessTimes& times : bottleneck.roles) {
    std::string line = fmt::format("{} x{}:", times.role, times.processes);
    for (const StageShare& share : times.stages) {
      line += fmt::format(" {} {:.0f} %,", WordsOf(share.stage), 100 * share.share);
    }
    line += fmt::format(" {:.1f} cores", times.cores);
    lines.push_back(std::move(line));
  }
  if (bottleneck.limited) {
    lines.push_back(
        fmt::format("limiter: held the actors {:.0f} %, the learner {:.0f} % of the time",
                    100 * bottleneck.inserts_blocked, 100 * bottleneck.samples_blocked));
  }
  if (!bottleneck.advice.empty()) lines.push_back(bottleneck.advice);
  return lines;
}

void WriteBottleneck(const std::filesystem::path& run, const Bottleneck& bottleneck) {
  ordered_json roles = ordered_json::array();
  for (const ProcessTimes& times : bottleneck.roles) {
    ordered_json shares = ordered_json::object();
    for (const StageShare& share : times.stages) shares[share.stage] = share.share;
    roles.push_back({{"role", times.role},
                     {"processes", times.processes},
                     {"seconds", times.seconds},
                     {"cores", times.cores},
                     {"shares", shares}});
  }
  const ordered_json object{{"schema", kBottleneckSchema},
                            {"roles", roles},
                            {"limiter",
                             {{"blocked_insert_share", bottleneck.inserts_blocked},
                              {"blocked_sample_share", bottleneck.samples_blocked}}},
                            {"cores_used", bottleneck.cores},
                            {"cores_usable", bottleneck.usable},
                            {"advice", bottleneck.advice}};
  WriteFileAtomically(run / kBottleneckFile, object.dump(2) + "\n");
}

}  // namespace shoal::launch
