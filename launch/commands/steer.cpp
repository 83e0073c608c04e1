// SPDX-License-Identifier: Apache-2.0
// shoal set, scale, stop: orders to a running run.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <thread>

#include "common/base/error.h"
#include "common/base/silence.h"
#include "common/base/stop.h"
#include "common/wire/process_name.h"
#include "launch/commands/commands.h"
#include "launch/commands/target_options.h"
#include "launch/record/run_folder.h"
#include "launch/run/live_settings.h"
#include "launch/watch/metrics_view.h"
#include "launch/watch/run_client.h"

namespace shoal::launch {
namespace {

using std::chrono::seconds;

constexpr seconds kInForce{10};  // for the processes to use a changed value
constexpr seconds kScaled{60};   // for actors to start, or to flush what they have and leave
constexpr seconds kCoordinatorSilence{15};                // as long as its processes wait for it
constexpr std::chrono::milliseconds kLookAtSilence{500};  // at the silence
constexpr seconds kLeaves{10};     // for the coordinator to leave, once it has said all
constexpr seconds kStopped{3600};  // for a run that had begun its last evaluation

// Looks at views until `done` says so; false: not within `most`, or a stop signal. Throws Error
// when the coordinator has been silent for kCoordinatorSilence: it died, and no view will ever
// come.
bool WatchUntil(RunClient& client, seconds most,
                const std::function<bool(const RunViewMessage&)>& done) {
  const SteadyTime deadline = Now() + most;
  Silence silence(Now());
  while (!StopRequested() && Now() < deadline) {
    const auto view = client.WaitForView(std::min(deadline, Now() + kLookAtSilence));
    if (view) silence.Heard(Now());
    if (view && done(*view)) return true;
    if (silence.Look(Now()) > kCoordinatorSilence) {
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

// "replay-0 32, learner-0 32"; empty while some process still uses another value.
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
    if (!any && use.role != ProcessName::Replay(0).role) return "";
  }
  return text;
}

// After Ctrl-C: the order was accepted and is carried out whoever waits.
int NotWaitedFor() {
  fmt::print("accepted; not waited for\n");
  return 0;
}

int Set(const TargetOptions& target, const std::string& assignment) {
  InstallStopSignals();
  RunClient client(ResolveTarget(target));
  const ReplyMessage done = client.Order("set", {assignment});
  fmt::print("{}\n", done.text);
  const auto live = std::ranges::find(LiveKeys(), done.key, &LiveKey::key);
  if (live == LiveKeys().end()) return 0;
  std::string where;
  const bool seen = WatchUntil(client, kInForce, [&](const RunViewMessage& view) {
    return !(where = InForce(view, *live, done.to)).empty();
  });
  if (!seen && StopRequested()) return NotWaitedFor();
  if (!seen) {
    throw RuntimeError("accepted, but not in force at every process within {} s: see shoal top",
                       kInForce.count());
  }
  fmt::print("in force: {}\n", where);
  return 0;
}

int Scale(const TargetOptions& target, int actors) {
  InstallStopSignals();
  RunClient client(ResolveTarget(target));
  fmt::print("{}\n", client.Order("scale", {std::to_string(actors)}).text);
  const bool there = WatchUntil(client, kScaled, [&](const RunViewMessage& view) {
    const auto states = StatesOfActors(view);
    return static_cast<int>(states.size()) == actors &&
           std::ranges::none_of(states, [](const std::string& state) {
             return state == "silent" || state == "stopping" || state == "draining";
           });
  });
  if (!there && StopRequested()) return NotWaitedFor();
  if (!there) {
    throw RuntimeError("accepted, but {} actors are not there within {} s: see shoal top", actors,
                       kScaled.count());
  }
  fmt::print("{} actor(s) report\n", actors);
  return 0;
}

int Stop(const TargetOptions& target) {
  InstallStopSignals();
  const RunTarget run = ResolveTarget(target);
  RunClient client(run);
  // Events of before the order are not its doing.
  const std::vector<RunEvent> before = client.FirstView().events;
  uint64_t shown = before.empty() ? 0 : before.back().number;
  fmt::print("{}\n", client.Order("stop", {}).text);
  std::fflush(stdout);
  int exit_code = 1;
  const bool ended = WatchUntil(client, kStopped, [&](const RunViewMessage& view) {
    for (const RunEvent& event : view.events) {
      if (event.number <= shown) continue;
      shown = event.number;
      if (event.text.starts_with("command: stop: ")) continue;  // the answer that was printed
      fmt::print("{}\n", event.text);
    }
    std::fflush(stdout);
    exit_code = view.state == "ended" ? ExitCodeOf(view) : 1;
    return view.state == "ended";
  });
  if (!ended && StopRequested()) return NotWaitedFor();
  if (!ended) throw RuntimeError("the run was told to stop, its end was not seen");
  // So that who comes next finds the run free.
  const SteadyTime deadline = Now() + kLeaves;
  while (!run.folder.empty() && IsHeld(run.folder) && Now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return exit_code;
}

}  // namespace

void AddSteerCommands(CLI::App& app, Action* chosen) {
  const auto target = std::make_shared<TargetOptions>();
  const auto assignment = std::make_shared<std::string>();
  const auto actors = std::make_shared<int>(0);

  CLI::App* set = app.add_subcommand(
      "set", "Change a key of a running run: " + LiveKeyNames() + ". Recorded in its meta.json.");
  AddTargetOptions(*set, target.get());
  set->add_option("assignment", *assignment, "KEY=VALUE")->required();
  set->callback([=] { *chosen = [=] { return Set(*target, *assignment); }; });

  CLI::App* scale = app.add_subcommand(
      "scale",
      "Change the number of actors of a running run. Those that go first flush what they "
      "have.");
  AddTargetOptions(*scale, target.get());
  scale->add_option("--actors", *actors, "How many there shall be")
      ->required()
      ->check(CLI::Range(1, 1024));
  scale->callback([=] { *chosen = [=] { return Scale(*target, *actors); }; });

  CLI::App* stop = app.add_subcommand(
      "stop",
      "Stop a running run in order, as Ctrl-C does; returns when it has ended, with its "
      "exit code. Ctrl-C here leaves it to itself.");
  AddTargetOptions(*stop, target.get());
  stop->callback([=] { *chosen = [=] { return Stop(*target); }; });
}

}  // namespace shoal::launch
