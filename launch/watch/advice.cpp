// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include "launch/watch/best_split.h"

namespace shoal::launch {
namespace {

// Shares of the time above which a process counts as held back, or as always busy.
constexpr double kHeld = 0.2, kBusy = 0.8;
// Share of the time in which the replay server works above which its work delays batches.
constexpr double kOftenBusy = 0.5;
constexpr double kAllCores = 0.9;  // share of busy usable cores above which no core is spare
constexpr double kServers = 1;     // cores of replay server and evaluation if not measured
// Least predicted speed-up worth advising. Smaller ones are within the error of the prediction.
constexpr double kWorthAdvising = 1.15;

constexpr std::string_view kActing[] = {"physics", "rendering", "user_code", "conversion",
                                        "inference"};
constexpr std::string_view kLearning[] = {"forward", "backward", "optimiser", "weights",
                                          "checkpoint"};

// The largest of the stages; null if the role has none of them.
const StageShare* Largest(const Bottleneck& figures, std::string_view role,
                          std::span<const std::string_view> stages) {
  const StageShare* largest = nullptr;
  for (const ProcessTimes& times : figures.roles) {
    if (times.role != role) continue;
    for (const StageShare& share : times.stages) {
      if (std::ranges::find(stages, share.stage) == stages.end()) continue;
      if (largest == nullptr || share.share > largest->share) largest = &share;
    }
  }
  return largest;
}

bool NoCoreToSpare(const Bottleneck& figures) {
  return figures.usable > 0 && figures.cores >= kAllCores * figures.usable;
}

// Advice on how a run can act faster.
std::string MoreActing(const Bottleneck& figures, const RunResources& resources) {
  if (resources.actors_elsewhere) return "more actors would help (--hosts, when it is started)";
  if (NoCoreToSpare(figures)) {
    return fmt::format("all {:.0f} cores are busy, more of them would help", figures.usable);
  }
  if (figures.usable > 0 && resources.actors + 1 > figures.usable) {
    return fmt::format(
        "there are as many actors as cores ({:.0f}); actors on other hosts (--hosts) would help",
        figures.usable);
  }
  return fmt::format("add an actor (shoal scale --actors {})", resources.actors + 1);
}

std::string AdviseMoreActing(const Bottleneck& figures, const RunResources& resources) {
  const StageShare* stage = Largest(figures, "actor", kActing);
  const std::string most = stage == nullptr
                               ? ""
                               : fmt::format(" (which spend {:.0f} % of their time in {})",
                                             100 * stage->share, WordsOf(stage->stage));
  return fmt::format("The learner waits for the actors {:.0f} % of the time{}: {}.",
                     100 * figures.samples_blocked, most, MoreActing(figures, resources));
}

// On policy, actors and learner take turns. The side that waits less is the slower one.
std::string AdviseOnPolicy(const Bottleneck& figures, const RunResources& resources) {
  const double learner_waits = ShareOf(figures, "learner", "waiting_data");
  const double actors_wait = ShareOf(figures, "actor", "weights");
  const std::string waits = fmt::format(
      "The learner waits for rollouts {:.0f} % of the time, the actors for weights "
      "{:.0f} %",
      100 * learner_waits, 100 * actors_wait);
  if (learner_waits >= actors_wait) return waits + ": " + MoreActing(figures, resources) + ".";
  if (!resources.may_play_ahead) return waits + ".";
  return waits +
         ": the actors could play meanwhile (--set ppo.versions_ahead=1 at the next start).";
}

// The best division of the cores and its predicted speed-up. The costs are estimated from the stage
// times of the present division, per unit of progress.
struct BetterSplit {
  Split split;
  double gain = 1;
};
BetterSplit FindBetterSplit(const Bottleneck& figures, const RunResources& resources) {
  const Split now{.actors = resources.actors, .threads = resources.learner_threads};
  if (now.threads == 0 || resources.most_threads == 0 || resources.actors_elsewhere) return {now};
  double servers = 0;
  for (const ProcessTimes& times : figures.roles) {
    if (times.role == "replay" || times.role == "eval") servers += times.cores;
  }
  if (servers == 0) servers = kServers;
  CoreCosts costs{.env_step = now.actors * (1 - ShareOf(figures, "actor", "waiting_credit")),
                  .update = 1,
                  .updates_per_env_step = 1,
                  .servers = servers};
  // Updates of the present threads if they never waited.
  const double possible = 1 / (1 - ShareOf(figures, "learner", "waiting_data"));
  costs.update = UpdatesPerSecond(costs, now.threads) / possible;
  if (!std::isfinite(possible) || costs.env_step <= 0) return {now};
  const Split best =
      BestSplit(costs, {.cores = int(figures.usable), .most_threads = resources.most_threads});
  // The model assumes that neither side waits. Waits that keep the present pace below the modelled
  // one would occur in the other division, too.
  return {.split = best, .gain = PaceOf(costs, best) / PaceOf(costs, now)};
}

std::string AdviseMoreLearning(const Bottleneck& figures, const RunResources& resources) {
  const StageShare* stage = Largest(figures, "learner", kLearning);
  const std::string most = stage == nullptr
                               ? ""
                               : fmt::format(" (which spends {:.0f} % of its time in {})",
                                             100 * stage->share, stage->stage);
  std::string advice =
      fmt::format("The learner sets the pace, the actors wait for it {:.0f} % of the time{}",
                  100 * figures.inserts_blocked, most);
  const BetterSplit better = FindBetterSplit(figures, resources);
  if (better.gain >= kWorthAdvising) {
    advice += fmt::format(
        ": about {:.1f} times as fast with --set learner.threads={} --set actors={} at the next "
        "start",
        better.gain, better.split.threads, better.split.actors);
  } else if (NoCoreToSpare(figures)) {
    advice += fmt::format("; all {:.0f} cores are busy", figures.usable);
  }
  return advice + ".";
}

std::string DescribeBusyReplay(const Bottleneck& figures) {
  return fmt::format(
      "The replay server is busy all the time ({:.0f} % inserting, {:.0f} % sampling, {:.0f} % "
      "sending) and sets the pace.",
      100 * ShareOf(figures, "replay", "inserting"), 100 * ShareOf(figures, "replay", "sampling"),
      100 * ShareOf(figures, "replay", "sending"));
}

// Whether the learner often waits for batches that the limiter does not withhold. Then the actors
// wait, too, but more learning would not help.
bool WaitsForGrantedBatches(const Bottleneck& figures) {
  return ShareOf(figures, "learner", "waiting_data") - figures.samples_blocked >= kHeld;
}

std::string AdviseFasterBatches(const Bottleneck& figures, double replay_works) {
  const std::string waits = fmt::format(
      "The learner waits for batches {:.0f} % of the time, though the limiter grants them",
      100 * ShareOf(figures, "learner", "waiting_data"));
  if (replay_works < kOftenBusy) return waits + ": raise learner.request_credits.";
  return fmt::format(
      "{}: the replay server sets the pace ({:.0f} % inserting, {:.0f} % sampling); raise "
      "replay.threads or learner.request_credits.",
      waits, 100 * ShareOf(figures, "replay", "inserting"),
      100 * ShareOf(figures, "replay", "sampling"));
}

std::string DescribeBalance(const Bottleneck& figures) {
  const StageShare* stage = Largest(figures, "learner", kLearning);
  return fmt::format(
      "No process waits for another: actors and learner are balanced. The learner spends most of "
      "its time on {} ({:.0f} %).",
      stage->stage, 100 * stage->share);
}

}  // namespace

std::string Advise(const Bottleneck& figures, const RunResources& resources) {
  const bool learning = Largest(figures, "learner", kLearning) != nullptr;
  if (!learning || figures.seconds < kLeastSeconds) return "";
  if (!figures.limited) return AdviseOnPolicy(figures, resources);
  const double replay_works =
      ShareOf(figures, "replay", "inserting") + ShareOf(figures, "replay", "sampling");
  if (replay_works >= kBusy || ShareOf(figures, "replay", "sending") >= kBusy) {
    return DescribeBusyReplay(figures);
  }
  if (figures.samples_blocked >= kHeld && figures.samples_blocked >= figures.inserts_blocked) {
    return AdviseMoreActing(figures, resources);
  }
  if (WaitsForGrantedBatches(figures)) return AdviseFasterBatches(figures, replay_works);
  if (figures.inserts_blocked >= kHeld) return AdviseMoreLearning(figures, resources);
  if (const double wait = ShareOf(figures, "actor", "waiting_credit"); wait >= kHeld) {
    return fmt::format(
        "The actors wait for credit {:.0f} % of the time, though the limiter grants it: raise "
        "replay.window_chunks.",
        100 * wait);
  }
  return DescribeBalance(figures);
}

}  // namespace shoal::launch
