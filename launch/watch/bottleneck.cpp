#include "launch/watch/bottleneck.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "common/base/files.h"
#include "common/wire/metric_names.h"

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;

// From these shares on somebody counts as held back, or as busy all the time.
constexpr double kHeld = 0.2, kBusy = 0.8;
constexpr double kAllCores = 0.9;  // of the usable ones in use: there is none to spare
constexpr double kLeastShown = 0.005;

constexpr std::string_view kRoles[] = {"actor", "replay", "learner", "eval"};
// Stages that run beside the others, on a thread of their own.
constexpr std::string_view kBeside[] = {"sending"};

double ShareOf(const Bottleneck& figures, std::string_view role, std::string_view stage) {
  for (const ProcessTimes& times : figures.roles) {
    if (times.role != role) continue;
    for (const StageShare& share : times.stages) {
      if (share.stage == stage) return share.share;
    }
  }
  return 0;
}

ProcessTimes TimesOf(const MetricsView& view, std::string_view role) {
  ProcessTimes times{.role = std::string(role)};
  times.processes = view.Processes(role);
  times.seconds = view.Seconds(role);
  if (times.seconds <= 0) return times;
  double named = 0;
  for (const Metric& metric : ProcessMetrics()) {
    if (metric.role != role || metric.kind != MetricKind::kStage) continue;
    const std::string stage(metric.name);
    const double share = view.Total(role, "seconds_" + stage) / times.seconds;
    if (share < kLeastShown) continue;
    times.stages.push_back({stage, share});
    if (std::ranges::find(kBeside, metric.name) == std::end(kBeside)) named += share;
  }
  if (1 - named >= kLeastShown) times.stages.push_back({"other", 1 - named});
  std::ranges::stable_sort(times.stages, std::ranges::greater(), &StageShare::share);
  // Replay and learner run as long as the run does; actors come and go.
  double run_seconds = times.seconds;
  for (const char* server : {"learner", "replay"}) {
    if (view.Seconds(server) > 0) run_seconds = view.Seconds(server);
  }
  times.cores = view.Total(role, "cpu_seconds") / run_seconds;
  return times;
}

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

std::string AdviseMoreActing(const Bottleneck& figures, int actors) {
  const std::string why = fmt::format("The learner waits for the actors {:.0f} % of the time",
                                      100 * figures.samples_blocked);
  if (NoCoreToSpare(figures)) {
    return fmt::format(
        "{}, and all {:.0f} cores are busy: add cores, or raise replay.samples_per_insert to learn "
        "more from each step (shoal set).",
        why, figures.usable);
  }
  const StageShare* stage = Largest(figures, "actor", {"physics", "rendering", "inference"});
  const std::string most = stage == nullptr
                               ? ""
                               : fmt::format(" (which spend {:.0f} % of their time in {})",
                                             100 * stage->share, stage->stage);
  return fmt::format(
      "{}{}: add an actor (shoal scale --actors {}) or raise "
      "replay.samples_per_insert.",
      why, most, actors + 1);
}

// On policy actors and learner take turns; who waits more says whose part is the longer one.
std::string AdviseOnPolicy(const Bottleneck& figures, int actors) {
  const double learner_waits = ShareOf(figures, "learner", "waiting_data");
  const double actors_wait = ShareOf(figures, "actor", "weights");
  if (learner_waits >= actors_wait) {
    const std::string more =
        NoCoreToSpare(figures)
            ? fmt::format("all {:.0f} cores are busy: more of them would help", figures.usable)
            : fmt::format("add an actor (shoal scale --actors {})", actors + 1);
    return fmt::format(
        "The learner waits for rollouts {:.0f} % of the time, the actors for weights {:.0f} %: {}.",
        100 * learner_waits, 100 * actors_wait, more);
  }
  return fmt::format(
      "The actors wait for weights {:.0f} % of the time, the learner for rollouts {:.0f} %: let "
      "them play meanwhile (ppo.versions_ahead), or learn less of each rollout (ppo.epochs).",
      100 * actors_wait, 100 * learner_waits);
}

std::string AdviseMoreLearning(const Bottleneck& figures) {
  const StageShare* stage =
      Largest(figures, "learner", {"forward", "backward", "optimiser", "weights", "checkpoint"});
  const std::string most = stage == nullptr
                               ? ""
                               : fmt::format(" (which spends {:.0f} % of its time in {})",
                                             100 * stage->share, stage->stage);
  const std::string faster =
      NoCoreToSpare(figures)
          ? fmt::format("all {:.0f} cores are busy, so take an actor away (shoal scale)",
                        figures.usable)
          : "give it more threads (learner.threads), take an actor away (shoal scale),";
  return fmt::format(
      "The actors wait for the learner {:.0f} % of the time{}: {} or lower "
      "replay.samples_per_insert.",
      100 * figures.inserts_blocked, most, faster);
}

}  // namespace

Bottleneck FindBottleneck(const MetricsView& view, double usable_cores, int actors) {
  Bottleneck result;
  result.usable = usable_cores;
  for (const std::string_view role : kRoles) {
    ProcessTimes times = TimesOf(view, role);
    if (times.seconds <= 0) continue;
    result.cores += times.cores;
    result.roles.push_back(std::move(times));
  }
  const double replay_seconds = view.Seconds("replay");
  result.limited = replay_seconds > 0;
  if (replay_seconds > 0) {
    const auto share = [&](const char* name) {
      return view.Total("replay", name) / replay_seconds;
    };
    result.inserts_blocked = share("limiter_blocked_insert_seconds");
    result.samples_blocked = share("limiter_blocked_sample_seconds");
  }
  result.advice = Advise(result, actors);
  return result;
}

std::string Advise(const Bottleneck& figures, int actors) {
  const double learner_waits = ShareOf(figures, "learner", "waiting_data");
  const double actors_wait = ShareOf(figures, "actor", "waiting_credit");
  const double replay_works =
      ShareOf(figures, "replay", "inserting") + ShareOf(figures, "replay", "sampling");
  if (figures.roles.empty()) return "Nothing was measured.";
  if (!figures.limited) return AdviseOnPolicy(figures, actors);
  if (replay_works >= kBusy || ShareOf(figures, "replay", "sending") >= kBusy) {
    return fmt::format(
        "The replay server is busy all the time ({:.0f} % inserting, {:.0f} % sampling, {:.0f} % "
        "sending): use smaller batches (learner.batch) or fewer actors.",
        100 * ShareOf(figures, "replay", "inserting"), 100 * ShareOf(figures, "replay", "sampling"),
        100 * ShareOf(figures, "replay", "sending"));
  }
  if (figures.samples_blocked >= kHeld && figures.samples_blocked >= figures.inserts_blocked) {
    return AdviseMoreActing(figures, actors);
  }
  if (figures.inserts_blocked >= kHeld) return AdviseMoreLearning(figures);
  if (learner_waits >= kHeld) {
    return fmt::format(
        "The learner waits for batches {:.0f} % of the time, though the limiter grants them: raise "
        "learner.request_credits.",
        100 * learner_waits);
  }
  if (actors_wait >= kHeld) {
    return fmt::format(
        "The actors wait for credit {:.0f} % of the time, though the limiter grants it: raise "
        "replay.window_chunks.",
        100 * actors_wait);
  }
  const StageShare* stage =
      Largest(figures, "learner", {"forward", "backward", "optimiser", "weights", "checkpoint"});
  if (stage == nullptr) return "Nobody waits, and the learner has not begun.";
  return fmt::format(
      "Nobody waits: actors and learner are balanced; what takes most is the learner's {} ({:.0f} "
      "% "
      "of its time).",
      stage->stage, 100 * stage->share);
}

std::vector<std::string> FormatBottleneck(const Bottleneck& bottleneck) {
  std::vector<std::string> lines;
  for (const ProcessTimes& times : bottleneck.roles) {
    std::string line = fmt::format("{} x{}:", times.role, times.processes);
    for (const StageShare& share : times.stages) {
      std::string stage = share.stage;
      std::ranges::replace(stage, '_', ' ');
      line += fmt::format(" {} {:.0f} %,", stage, 100 * share.share);
    }
    line += fmt::format(" {:.1f} cores", times.cores);
    lines.push_back(std::move(line));
  }
  if (bottleneck.limited) {
    lines.push_back(
        fmt::format("limiter: held the actors {:.0f} %, the learner {:.0f} % of the time",
                    100 * bottleneck.inserts_blocked, 100 * bottleneck.samples_blocked));
  }
  lines.push_back(bottleneck.advice);
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
  const ordered_json object{{"schema", "shoal-bottleneck-1"},
                            {"roles", roles},
                            {"limiter",
                             {{"blocked_insert_share", bottleneck.inserts_blocked},
                              {"blocked_sample_share", bottleneck.samples_blocked}}},
                            {"cores_used", bottleneck.cores},
                            {"cores_usable", bottleneck.usable},
                            {"advice", bottleneck.advice}};
  WriteFileAtomically(run / "bottleneck.json", object.dump(2) + "\n");
}

}  // namespace shoal::launch
