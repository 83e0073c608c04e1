// shoal-bench-actors: one replay server under 4, 16, 64 and 256 actor processes, and how fast real
// actors are, as JSON (schema shoal-bench-1) on stdout. `./run bench-actors`.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "common/base/build_info.h"
#include "common/base/command_line.h"
#include "common/base/main_guard.h"
#include "common/base/stop.h"
#include "launch/processes/process_plan.h"
#include "launch/processes/scratch_folder.h"
#include "launch/record/machine.h"
#include "tests/benchmark/many_actors.h"
#include "tests/benchmark/paired_timing.h"
#include "tests/benchmark/real_actors.h"

namespace {

using shoal::bench::ManyActorsFigures;
using shoal::bench::ManyActorsOptions;
using shoal::bench::Row;

constexpr double kFoundSeconds = 2;  // meant for all actors to be found in

// The replay's cost of a transition, as a rate: beside that under 16 actors, or under the fewest.
Row CostRow(const ManyActorsFigures& figures, const ManyActorsFigures& few) {
  const auto rate = [](const ManyActorsFigures& of) { return 1e6 / of.replay_us_per_transition; };
  return {.stage = fmt::format("replay server under {} actor processes", figures.actors),
          .unit = "transitions per CPU second",
          .against = fmt::format("{} actor processes", few.actors),
          .figure = rate(figures),
          .against_figure = rate(few),
          .ratio = rate(figures) / rate(few),
          .target = figures.actors > few.actors ? 1.0 : 0.0,
          .repetitions = 1};
}

nlohmann::ordered_json WithDetails(const Row& row, const ManyActorsFigures& figures) {
  nlohmann::ordered_json json = ToJson(row);
  json["transitions_per_second"] = figures.transitions_per_second;
  json["replay_us_per_transition"] = figures.replay_us_per_transition;
  json["actor_us_per_transition"] = figures.actor_us_per_transition;
  json["start_seconds"] = figures.start_seconds;
  json["made"] = figures.made;
  json["stored"] = figures.stored;
  json["lost_with_process"] = figures.lost;
  return json;
}

nlohmann::ordered_json FoundRow(const ManyActorsFigures& figures) {
  return {{"stage", fmt::format("the last of {} actor processes is found", figures.actors)},
          {"figure", figures.found_seconds},
          {"unit", "s after its start"},
          {"against", "nothing"},
          {"against_figure", nullptr},
          {"ratio", nullptr},
          {"target", nullptr},
          {"at_most", kFoundSeconds},
          {"repetitions", 1},
          {"spread", nullptr}};
}

// Adds both rows of each number of actors.
void MeasureCounts(const std::vector<int>& counts, ManyActorsOptions options,
                   nlohmann::ordered_json* rows) {
  std::vector<ManyActorsFigures> all;
  for (const int actors : counts) {
    const shoal::launch::ScratchFolder folder;
    options.folder = folder.path();
    options.actors = actors;
    all.push_back(shoal::bench::MeasureManyActors(options));
    const ManyActorsFigures& figures = all.back();
    std::cerr << fmt::format(
        "{} actors: started in {:.2f} s, all found {:.2f} s later; {:.0f} transitions/s, {:.1f} us "
        "of the replay each, {:.1f} us of an actor\n",
        actors, figures.start_seconds, figures.found_seconds, figures.transitions_per_second,
        figures.replay_us_per_transition, figures.actor_us_per_transition);
  }
  const auto sixteen = std::ranges::find(all, 16, &ManyActorsFigures::actors);
  const ManyActorsFigures& few = sixteen == all.end() ? all[0] : *sixteen;
  for (const ManyActorsFigures& figures : all) {
    rows->push_back(WithDetails(CostRow(figures, few), figures));
    rows->push_back(FoundRow(figures));
  }
}

int Run(int argc, char** argv) {
  std::vector<int> counts{4, 16, 64, 256};
  ManyActorsOptions options;
  int repetitions = 3;
  bool real = false, fake = false;
  CLI::App app("Measures a replay server under many actor processes, and real actors.",
               "shoal-bench-actors");
  shoal::AddVersion(&app);
  app.add_option("--actors", counts, "numbers of actor processes")->check(CLI::Range(1, 1024));
  app.add_option("--steps-per-second", options.steps_per_second, "of each actor")
      ->check(CLI::Range(1.0, 1e5));
  app.add_option("--seconds", options.seconds, "measured for each number")
      ->check(CLI::Range(1.0, 600.0));
  app.add_option("--repetitions", repetitions, "of what real actors are held to; the median counts")
      ->check(CLI::Range(1, 100));
  auto* only_real = app.add_flag("--real", real, "real actors alone");
  app.add_flag("--fake", fake, "actors that cost nothing but time alone")->excludes(only_real);
  if (const auto exit_code = shoal::ParseCommandLine(&app, argc, argv)) return *exit_code;
  options.programs = shoal::launch::ProgramFolder();
  shoal::InstallStopSignals();  // an interrupted one takes its processes and files with it

  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  if (!real) MeasureCounts(counts, options, &rows);
  if (!fake) {
    for (const Row& row : shoal::bench::RealActorRows(options, repetitions)) {
      rows.push_back(ToJson(row));
      std::cerr << shoal::bench::LineOf(row) << "\n";
    }
  }
  const nlohmann::ordered_json report{{"schema", "shoal-bench-1"},
                                      {"commit", shoal::BuildCommit()},
                                      {"machine", shoal::launch::DescribeMachine()},
                                      {"rows", rows}};
  std::cout << report.dump(2) << std::endl;
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return shoal::GuardMain("shoal-bench-actors", [&] { return Run(argc, argv); });
}
