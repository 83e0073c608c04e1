// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/advice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <vector>

namespace shoal::launch {
namespace {

// From these shares on somebody counts as held back, or as busy all the time.
constexpr double kHeld = 0.2, kBusy = 0.8;
constexpr double kAllCores = 0.9;  // of the usable ones in use: there is none to spare

// The largest of the stages, for saying what the process does all the time.
const StageShare* Largest(const Bottleneck& figures, std::string_view role,
                          std::initializer_list<std::string_view> stages) {
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

// What would let a run act faster.
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
  const StageShare* stage = Largest(figures, "actor", {"physics", "rendering", "inference"});
  const std::string most = stage == nullptr
                               ? ""
                               : fmt::format(" (which spend {:.0f} % of their time in {})",
                                             100 * stage->share, stage->stage);
  return fmt::format(
      "The learner waits for the actors {:.0f} % of the time{}: {}. A higher "
      "replay.samples_per_insert would learn more from each env step meanwhile.",
      100 * figures.samples_blocked, most, MoreActing(figures, resources));
}

// On policy actors and learner take turns; who waits more says whose part is the longer one.
std::string AdviseOnPolicy(const Bottleneck& figures, const RunResources& resources) {
  const double learner_waits = ShareOf(figures, "learner", "waiting_data");
  const double actors_wait = ShareOf(figures, "actor", "weights");
  if (learner_waits >= actors_wait) {
    return fmt::format(
        "The learner waits for rollouts {:.0f} % of the time, the actors for weights {:.0f} %: {}.",
        100 * learner_waits, 100 * actors_wait, MoreActing(figures, resources));
  }
  return fmt::format(
      "The actors wait for weights {:.0f} % of the time, the learner for rollouts {:.0f} %: let "
      "them play meanwhile (ppo.versions_ahead), or learn less of each rollout (ppo.epochs).",
      100 * actors_wait, 100 * learner_waits);
}

// That actors wait is as it should be where a run learns often from each step.
std::string AdviseMoreLearning(const Bottleneck& figures, const RunResources& resources) {
  const StageShare* stage =
      Largest(figures, "learner", {"forward", "backward", "optimiser", "weights", "checkpoint"});
  const std::string most = stage == nullptr
                               ? ""
                               : fmt::format(" (which spends {:.0f} % of its time in {})",
                                             100 * stage->share, stage->stage);
  std::vector<std::string> ways;
  if (NoCoreToSpare(figures)) {
    ways.push_back(fmt::format("all {:.0f} cores are busy", figures.usable));
  } else {
    ways.push_back("more threads may speed it up (learner.threads)");
  }
  if (resources.actors > 1 && !resources.actors_elsewhere) {
    ways.push_back(
        fmt::format("fewer actors would do (shoal scale --actors {})", resources.actors - 1));
  }
  return fmt::format(
      "The learner sets the pace, the actors wait for it {:.0f} % of the time{}: {}. A lower "
      "replay.samples_per_insert would make fewer updates of each env step.",
      100 * figures.inserts_blocked, most, fmt::join(ways, ", and "));
}

std::string AdviseLighterReplay(const Bottleneck& figures, const RunResources& resources) {
  return fmt::format(
      "The replay server is busy all the time ({:.0f} % inserting, {:.0f} % sampling, {:.0f} % "
      "sending): use smaller batches (learner.batch){}.",
      100 * ShareOf(figures, "replay", "inserting"), 100 * ShareOf(figures, "replay", "sampling"),
      100 * ShareOf(figures, "replay", "sending"), resources.actors > 1 ? " or fewer actors" : "");
}

std::string DescribeBalance(const Bottleneck& figures) {
  const StageShare* stage =
      Largest(figures, "learner", {"forward", "backward", "optimiser", "weights", "checkpoint"});
  if (stage == nullptr) return "No process waits for another, and the learner has not begun.";
  return fmt::format(
      "No process waits for another: actors and learner are balanced. The learner spends most of "
      "its "
      "time on {} ({:.0f} %).",
      stage->stage, 100 * stage->share);
}

}  // namespace

std::string Advise(const Bottleneck& figures, const RunResources& resources) {
  if (figures.roles.empty()) return "Nothing has been measured yet.";
  if (!figures.limited) return AdviseOnPolicy(figures, resources);
  const double replay_works =
      ShareOf(figures, "replay", "inserting") + ShareOf(figures, "replay", "sampling");
  if (replay_works >= kBusy || ShareOf(figures, "replay", "sending") >= kBusy) {
    return AdviseLighterReplay(figures, resources);
  }
  if (figures.samples_blocked >= kHeld && figures.samples_blocked >= figures.inserts_blocked) {
    return AdviseMoreActing(figures, resources);
  }
  if (figures.inserts_blocked >= kHeld) return AdviseMoreLearning(figures, resources);
  if (const double waits = ShareOf(figures, "learner", "waiting_data"); waits >= kHeld) {
    return fmt::format(
        "The learner waits for batches {:.0f} % of the time, though the limiter grants them: raise "
        "learner.request_credits.",
        100 * waits);
  }
  if (const double wait = ShareOf(figures, "actor", "waiting_credit"); wait >= kHeld) {
    return fmt::format(
        "The actors wait for credit {:.0f} % of the time, though the limiter grants it: raise "
        "replay.window_chunks.",
        100 * wait);
  }
  return DescribeBalance(figures);
}

}  // namespace shoal::launch
