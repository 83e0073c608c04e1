// SPDX-License-Identifier: Apache-2.0
#include "launch/client/run_orders.h"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <utility>

#include "common/base/error.h"
#include "common/base/liveness_timer.h"
#include "common/base/sleep.h"
#include "common/base/stop.h"
#include "common/link/role.h"
#include "common/wire/process_name.h"
#include "launch/record/run_folder.h"
#include "launch/run/live_settings.h"
#include "launch/watch/metrics_view.h"

namespace shoal::launch {
namespace {

using std::chrono::seconds;

constexpr std::chrono::milliseconds kLookAtSilence{500};  // interval of liveness checks
constexpr std::chrono::milliseconds kLookAtFolder{20};

// Reads views until `done` returns true. Returns false after `most` or on a stop signal. Throws
// Error if the coordinator has been silent for kCoordinatorSilence: it is presumed dead.
bool WatchUntil(RunClient& client, seconds most,
                const std::function<bool(const RunViewMessage&)>& done) {
  const SteadyTime deadline = Now() + most;
  LivenessTimer liveness(Now());
  while (!StopRequested() && Now() < deadline) {
    const auto view = client.WaitForView(std::min(deadline, Now() + kLookAtSilence));
    if (view) liveness.Heard(Now());
    if (view && done(*view)) return true;
    if (liveness.Look(Now()) > kCoordinatorSilence) {
      throw RuntimeError(
          "accepted, but the run's coordinator has been silent for {} s: see shoal runs",
          kCoordinatorSilence.count());
    }
  }
  return false;
}

std::vector<std::string> StatesOfActors(const RunViewMessage& view) {
  std::vector<std::string> states;
  for (const MetricsMessage& process : view.processes) {
    if (process.role == "actor") states.push_back(process.state);
  }
  return states;
}

// "replay-0 32, learner-0 32"; empty while any process still uses another value.
std::string InForce(const RunViewMessage& message, const LiveKey& live, double value) {
  MetricsView view;
  for (const MetricsMessage& process : message.processes) view.OnMessage(process, Now());
  std::string text;
  for (const SettingUse& use : live.uses) {
    bool any = false;
    for (const MetricsMessage& process : message.processes) {
      if (process.role != use.role) continue;
      any = true;
      const ProcessName name{.role = use.role, .index = process.id};
      const auto used = view.Get(name, use.metric);
      if (used != value) return "";
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name.Text(), *used);
    }
    // A run that learns on policy has no replay.
    if (!any && use.role != link::RoleName(link::Role::kReplay)) return "";
  }
  return text;
}

// After Ctrl-C: the order was accepted, and the run executes it without this command.
int NotWaitedFor(const Say& say) {
  say("accepted; this command did not wait for the effect");
  return 0;
}

// An ending run does not execute orders that take time.
bool IsEnding(const RunViewMessage& view) { return view.state != "running"; }

// KEY=VALUE as the coordinator has accepted it: the value is a number.
struct Setting {
  std::string key;
  double value = 0;
};

std::vector<Setting> SettingsOf(const std::vector<std::string>& assignments) {
  std::vector<Setting> settings;
  for (const std::string& assignment : assignments) {
    const size_t equals = assignment.find('=');
    settings.push_back(
        {assignment.substr(0, equals), std::strtod(assignment.c_str() + equals + 1, nullptr)});
  }
  return settings;
}

// "replay-0 32, learner-0 32" for each setting; empty while any process still uses another value.
std::string AllInForce(const RunViewMessage& view, const std::vector<Setting>& settings) {
  std::string text;
  for (const Setting& setting : settings) {
    const auto live = std::ranges::find(LiveKeys(), setting.key, &LiveKey::key);
    if (live == LiveKeys().end()) continue;
    const std::string where = InForce(view, *live, setting.value);
    if (where.empty()) return "";
    text += (text.empty() ? "" : "; ") + where;
  }
  return text;
}

// The newest accepted `scale` order in a view ("actors: 2 -> 3") if it is later than `ours`; else
// empty.
std::string LaterScale(const RunViewMessage& view, const std::string& ours) {
  std::string later;
  bool after_ours = false;
  for (const RunEvent& event : view.events) {
    const size_t change = event.text.find("actors: ");
    if (!event.text.starts_with("command: scale ") || change == std::string::npos) continue;
    if (event.text.find("refused") != std::string::npos) continue;
    if (event.text.substr(change) == ours) {
      after_ours = true;
      later.clear();
    } else if (after_ours) {
      later = event.text.substr(change);
    }
  }
  return later;
}

bool AllActorsReport(const RunViewMessage& view, int actors) {
  const auto states = StatesOfActors(view);
  return static_cast<int>(states.size()) == actors &&
         std::ranges::none_of(states, [](const std::string& state) {
           return state == "silent" || state == "stopping" || state == "draining";
         });
}

// Prints events with numbers above `*shown`.
void SayEvents(const RunViewMessage& view, uint64_t* shown, const Say& say) {
  for (const RunEvent& event : view.events) {
    if (event.number <= *shown) continue;
    *shown = event.number;
    if (event.text.starts_with("command: stop: ")) continue;  // already printed as the reply
    say(event.text);
  }
}

}  // namespace

int SetKeys(RunClient& client, const std::vector<std::string>& assignments, const Say& say) {
  say(client.Order("set", assignments).text);
  const std::vector<Setting> settings = SettingsOf(assignments);
  std::string where;
  bool ending = false;
  const bool seen = WatchUntil(client, kInForce, [&](const RunViewMessage& view) {
    ending = IsEnding(view);
    where = AllInForce(view, settings);
    return ending || !where.empty();
  });
  if (!seen && StopRequested()) return NotWaitedFor(say);
  if (!seen) {
    throw RuntimeError("accepted, but not in force at every process within {} s: see shoal top",
                       kInForce.count());
  }
  say(where.empty() ? "the run is ending" : "in force: " + where);
  return 0;
}

int ScaleActors(RunClient& client, int actors, const Say& say) {
  const std::string ours = client.Order("scale", {std::to_string(actors)}).text;
  say(ours);
  std::string later;
  bool ending = false;
  const bool there = WatchUntil(client, kScaled, [&](const RunViewMessage& view) {
    later = LaterScale(view, ours);
    ending = IsEnding(view);
    return ending || !later.empty() || AllActorsReport(view, actors);
  });
  if (!there && StopRequested()) return NotWaitedFor(say);
  if (!there) {
    throw RuntimeError("accepted, but {} actors have not reported within {} s: see shoal top",
                       actors, kScaled.count());
  }
  if (!later.empty()) {
    say("another command has changed the number again: " + later);
  } else {
    say(ending ? "the run is ending" : fmt::format("{} actor(s) report", actors));
  }
  return 0;
}

int StopRun(RunClient& client, const std::filesystem::path& folder, const Say& say) {
  // Earlier events were not caused by this order.
  const RunViewMessage first = client.FirstView();
  SameCoordinator coordinator;
  coordinator.Take(first);
  uint64_t shown = first.events.empty() ? 0 : first.events.back().number;
  say(client.Order("stop", {}).text);
  int exit_code = 1;
  const bool ended = WatchUntil(client, kStopped, [&](const RunViewMessage& view) {
    if (!coordinator.Take(view)) {
      throw RuntimeError(
          "accepted, but the run's coordinator is gone and another one has resumed the run: see "
          "shoal runs");
    }
    SayEvents(view, &shown, say);
    exit_code = view.state == "ended" ? ExitCodeOf(view) : 1;
    return view.state == "ended";
  });
  if (!ended && StopRequested()) return NotWaitedFor(say);
  if (!ended) throw RuntimeError("the run accepted the stop, but has not ended in time");
  // Wait for the coordinator to exit, so that a following command finds the run unlocked.
  const SteadyTime deadline = Now() + kLeaves;
  while (!folder.empty() && IsHeld(folder) && Now() < deadline) SleepFor(kLookAtFolder);
  return exit_code;
}

}  // namespace shoal::launch
