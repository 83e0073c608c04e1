// SPDX-License-Identifier: Apache-2.0
// shoal set, scale, stop: orders to a running run.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "common/base/error.h"
#include "common/base/stop.h"
#include "common/wire/process_name.h"
#include "launch/client/run_connection.h"
#include "launch/client/run_orders.h"
#include "launch/commands/commands.h"
#include "launch/commands/target_options.h"
#include "launch/run/live_settings.h"

namespace shoal::launch {
namespace {

constexpr int kMost = static_cast<int>(kMostActors);

void PrintNow(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

// The arguments of `set` and `scale`, in any order: the run (optional if there is only one) and
// the change.
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
    throw UsageError("set: the assignment is missing; usage: shoal set [RUN] KEY=VALUE...");
  }
  InstallStopSignals();
  RunConnection connection(ResolveTarget(words.target));
  return SetKeys(connection.client(), assignments, PrintNow);
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
    throw UsageError("scale: the number of actors is missing; usage: shoal scale [RUN] N");
  }
  InstallStopSignals();
  RunConnection connection(ResolveTarget(words.target));
  return ScaleActors(connection.client(), words.actors, PrintNow);
}

int Stop(const TargetOptions& target) {
  InstallStopSignals();
  const RunTarget run = ResolveTarget(target);
  RunConnection connection(run);
  return StopRun(connection.client(), run.folder, PrintNow);
}

}  // namespace

void AddSteerCommands(CLI::App& app, Action* chosen) {
  const auto words = std::make_shared<SteerWords>();

  CLI::App* set = app.add_subcommand("set", "Change keys of a running run: " + LiveKeyNames() +
                                                ". The run's meta.json records each change.");
  AddNamedTargetOptions(*set, &words->target);
  set->add_option("assignment", words->words, "KEY=VALUE, one or more; or the run's name");
  set->callback([=] { *chosen = [=] { return Set(*words); }; });

  CLI::App* scale = app.add_subcommand("scale",
                                       "Change the number of actors of a running run. Removed "
                                       "actors send their remaining records first.");
  AddNamedTargetOptions(*scale, &words->target);
  scale->add_option("number", words->words, "Number of actors; or the run's name");
  scale->add_option("--actors", words->actors, "Number of actors")->check(CLI::Range(1, kMost));
  scale->callback([=] { *chosen = [=] { return Scale(*words); }; });

  CLI::App* stop = app.add_subcommand("stop",
                                      "Stop a running run as Ctrl-C does, wait for its end and "
                                      "return its exit code. Ctrl-C here stops only the waiting.");
  AddTargetOptions(*stop, &words->target);
  stop->callback([=] { *chosen = [=] { return Stop(words->target); }; });
}

}  // namespace shoal::launch
