// shoal-bench-actors: one replay server under 4, 16 and 64 actor processes, as JSON (schema
// shoal-bench-1) on stdout. `./run bench-actors`.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
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

namespace {

using shoal::bench::ManyActorsFigures;
using shoal::bench::ManyActorsOptions;

nlohmann::ordered_json Row(const ManyActorsFigures& figures, const ManyActorsFigures& few) {
  return {{"stage", fmt::format("replay server under {} actor processes", figures.actors)},
          {"figure", figures.replay_us_per_transition},
          {"unit", "us of CPU per transition"},
          {"against", fmt::format("{} actor processes", few.actors)},
          {"against_figure", few.replay_us_per_transition},
          {"ratio", figures.replay_us_per_transition / few.replay_us_per_transition},
          {"transitions_per_second", figures.transitions_per_second},
          {"actor_us_per_transition", figures.actor_us_per_transition},
          {"start_seconds", figures.start_seconds},
          {"found_seconds", figures.found_seconds},
          {"made", figures.made},
          {"stored", figures.stored},
          {"lost_with_process", figures.lost}};
}

int Run(int argc, char** argv) {
  std::vector<int> counts{4, 16, 64};
  ManyActorsOptions options;
  CLI::App app("Measures a replay server under many actor processes.", "shoal-bench-actors");
  shoal::AddVersion(&app);
  app.add_option("--actors", counts, "numbers of actor processes")->check(CLI::Range(1, 1024));
  app.add_option("--steps-per-second", options.steps_per_second, "of each actor")
      ->check(CLI::Range(1.0, 1e5));
  app.add_option("--seconds", options.seconds, "measured for each number")
      ->check(CLI::Range(1.0, 600.0));
  if (const auto exit_code = shoal::ParseCommandLine(&app, argc, argv)) return *exit_code;
  options.programs = shoal::launch::ProgramFolder();
  shoal::InstallStopSignals();  // an interrupted one takes its processes and files with it

  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  std::optional<ManyActorsFigures> few;
  for (const int actors : counts) {
    const shoal::launch::ScratchFolder folder;
    options.folder = folder.path();
    options.actors = actors;
    const ManyActorsFigures figures = shoal::bench::MeasureManyActors(options);
    if (!few) few = figures;
    rows.push_back(Row(figures, *few));
    std::cerr << fmt::format(
        "{} actors: started in {:.2f} s, all found {:.2f} s later; {:.0f} transitions/s, {:.1f} us "
        "of the replay each\n",
        actors, figures.start_seconds, figures.found_seconds, figures.transitions_per_second,
        figures.replay_us_per_transition);
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
