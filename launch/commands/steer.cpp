// SPDX-License-Identifier: Apache-2.0
// shoal set, scale, stop: orders to a running run.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <functional>
#include <memory>
#include <thread>

#include "common/base/error.h"
#include "common/base/liveness_timer.h"
#include "common/base/stop.h"
#include "common/link/role.h"
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

constexpr int kMost = static_cast<int>(kMostActors);
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
    if (!any && use.role != link::RoleName(link::Role::kReplay)) return "";
  }
  return text;
}

// After Ctrl-C: the order was accepted, and the run carries it out without this command.
int NotWaitedFor() {
  fmt::print("accepted; not waited for\n");
  return 0;
}

// A run that has begun to end carries out nothing that takes time.
bool IsEnding(const RunViewMessage& view) { return view.state != "running"; }

// The words after `set` and `scale`, in any order: the run, unless it is the only one, and the
// change.
struct SteerWords {
  TargetOptions target;
  std::vector<std::string> words;
  int actors = 0;

  // Takes `word` for the run's name. Throws Error (usage) for a second one.
  void TakeRun(const std::string& word, const char* expected) {
    if (!target.run.empty()) {
      throw UsageError("unexpected argument '{}' beside run '{}': expected {}", word, target.run,
                       expected);
    }
    target.run = word;
  }
};

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

// "replay-0 32, learner-0 32" of each setting; empty while some process still uses another value.
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

int Set(SteerWords words) {
  std::vector<std::string> assignments;
  for (const std::string& word : words.words) {
    if (word.find('=') == std::string::npos) {
      words.TakeRun(word, "KEY=VALUE");
    } else {
      assignments.push_back(word);
    }
  }
  if (assignments.empty()) {
    throw UsageError("set: nothing is to be set; usage: shoal set [RUN] KEY=VALUE...");
  }
  InstallStopSignals();
  RunClient client(ResolveTarget(words.target));
  fmt::print("{}\n", client.Order("set", assignments).text);
  const std::vector<Setting> settings = SettingsOf(assignments);
  std::string where;
  bool ending = false;
  const bool seen = WatchUntil(client, kInForce, [&](const RunViewMessage& view) {
    ending = IsEnding(view);
    where = AllInForce(view, settings);
    return ending || !where.empty();
  });
  if (!seen && StopRequested()) return NotWaitedFor();
  if (!seen) {
    throw RuntimeError("accepted, but not in force at every process within {} s: see shoal top",
                       kInForce.count());
  }
  fmt::print("{}\n", where.empty() ? "the run is ending" : "in force: " + where);
  return 0;
}

// The newest accepted order to scale in a view, "actors: 2 -> 3", if it came after `ours`; else
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

bool IsNumber(const std::string& word) {
  return !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
}

int Scale(SteerWords words) {
  for (const std::string& word : words.words) {
    if (words.actors == 0 && IsNumber(word)) {
      words.actors = std::atoi(word.c_str());
      if (words.actors < 1 || words.actors > kMost) {
        throw UsageError("scale: {} actors: expected 1..{}", word, kMost);
      }
    } else {
      words.TakeRun(word, "a number of actors");
    }
  }
  if (words.actors == 0) {
    throw UsageError(
        "scale: how many actors there shall be is missing; usage: shoal scale "
        "[RUN] N");
  }
  InstallStopSignals();
  RunClient client(ResolveTarget(words.target));
  const std::string ours = client.Order("scale", {std::to_string(words.actors)}).text;
  fmt::print("{}\n", ours);
  std::string later;
  bool ending = false;
  const bool there = WatchUntil(client, kScaled, [&](const RunViewMessage& view) {
    later = LaterScale(view, ours);
    ending = IsEnding(view);
    return ending || !later.empty() || AllActorsReport(view, words.actors);
  });
  if (!there && StopRequested()) return NotWaitedFor();
  if (!there) {
    throw RuntimeError("accepted, but {} actors are not there within {} s: see shoal top",
                       words.actors, kScaled.count());
  }
  if (!later.empty()) {
    fmt::print("another command has changed that: {}\n", later);
  } else if (ending) {
    fmt::print("the run is ending\n");
  } else {
    fmt::print("{} actor(s) report\n", words.actors);
  }
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
  if (!ended) throw RuntimeError("the run accepted the stop, but has not ended in time");
  // So that who comes next finds the run free.
  const SteadyTime deadline = Now() + kLeaves;
  while (!run.folder.empty() && IsHeld(run.folder) && Now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return exit_code;
}

}  // namespace

void AddSteerCommands(CLI::App& app, Action* chosen) {
  const auto words = std::make_shared<SteerWords>();

  CLI::App* set = app.add_subcommand(
      "set", "Change keys of a running run: " + LiveKeyNames() + ". Recorded in its meta.json.");
  AddNamedTargetOptions(*set, &words->target);
  set->add_option("assignment", words->words, "KEY=VALUE, one or more; or the run's name");
  set->callback([=] { *chosen = [=] { return Set(*words); }; });

  CLI::App* scale = app.add_subcommand(
      "scale",
      "Change the number of actors of a running run. Those that go first flush what they "
      "have.");
  AddNamedTargetOptions(*scale, &words->target);
  scale->add_option("actors", words->words, "How many there shall be; or the run's name");
  scale->add_option("--actors", words->actors, "How many there shall be")
      ->check(CLI::Range(1, kMost));
  scale->callback([=] { *chosen = [=] { return Scale(*words); }; });

  CLI::App* stop = app.add_subcommand(
      "stop",
      "Stop a running run in order, as Ctrl-C does; returns when it has ended, with its "
      "exit code. Ctrl-C here leaves it to itself.");
  AddTargetOptions(*stop, &words->target);
  stop->callback([=] { *chosen = [=] { return Stop(words->target); }; });
}

}  // namespace shoal::launch
