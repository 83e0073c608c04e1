// SPDX-License-Identifier: Apache-2.0
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
#include "tests/benchmark/hosted_actors.h"
#include "tests/benchmark/many_actors.h"
#include "tests/benchmark/paired_timing.h"
#include "tests/benchmark/real_actors.h"

namespace {

using shoal::bench::ManyActorsFigures;
using shoal::bench::ManyActorsOptions;
using shoal::bench::Row;

constexpr double kFoundSeconds = 2;  // meant for all actors to be found in

// Figures for one number of actors, repetition by repetition.
using Repetitions = std::vector<ManyActorsFigures>;

double MedianOf(const Repetitions& of, double ManyActorsFigures::*figure) {
  std::vector<double> values;
  for (const ManyActorsFigures& figures : of) values.push_back(figures.*figure);
  return shoal::bench::Median(values);
}

uint64_t SumOf(const Repetitions& of, uint64_t ManyActorsFigures::*count) {
  uint64_t sum = 0;
  for (const ManyActorsFigures& figures : of) sum += figures.*count;
  return sum;
}

// The replay's cost of a transition, as a rate, compared with the rate for 16 actors or, if that
// was not measured, for the first number of actors.
Row CostRow(const Repetitions& of, const Repetitions& few) {
  std::vector<double> rates, few_rates, ratios;
  for (size_t i = 0; i < of.size(); ++i) {
    rates.push_back(1e6 / of[i].replay_us_per_transition);
    few_rates.push_back(1e6 / few[i].replay_us_per_transition);
    ratios.push_back(rates.back() / few_rates.back());
  }
  const auto [least, most] = std::ranges::minmax(ratios);
  const double ratio = shoal::bench::Median(ratios);
  return {.stage = fmt::format("replay server under {} actor processes", of[0].actors),
          .unit = "transitions per CPU second",
          .against = fmt::format("{} actor processes", few[0].actors),
          .figure = shoal::bench::Median(rates),
          .against_figure = shoal::bench::Median(few_rates),
          .ratio = ratio,
          .spread = (most - least) / ratio,
          .target = of[0].actors > few[0].actors ? 1.0 : 0.0,
          .repetitions = static_cast<int>(of.size())};
}

// Medians, and the account of all repetitions together.
nlohmann::ordered_json WithDetails(const Row& row, const Repetitions& of) {
  nlohmann::ordered_json json = ToJson(row);
  json["transitions_per_second"] = MedianOf(of, &ManyActorsFigures::transitions_per_second);
  json["replay_us_per_transition"] = MedianOf(of, &ManyActorsFigures::replay_us_per_transition);
  json["actor_us_per_transition"] = MedianOf(of, &ManyActorsFigures::actor_us_per_transition);
  json["start_seconds"] = MedianOf(of, &ManyActorsFigures::start_seconds);
  json["made"] = SumOf(of, &ManyActorsFigures::made);
  json["stored"] = SumOf(of, &ManyActorsFigures::stored);
  json["lost_with_process"] = SumOf(of, &ManyActorsFigures::lost);
  return json;
}

nlohmann::ordered_json FoundRow(const Repetitions& of) {
  return {{"stage", fmt::format("the last of {} actor processes is found", of[0].actors)},
          {"figure", MedianOf(of, &ManyActorsFigures::found_seconds)},
          {"unit", "s after its start"},
          {"against", "nothing"},
          {"against_figure", nullptr},
          {"ratio", nullptr},
          {"target", nullptr},
          {"at_most", kFoundSeconds},
          {"repetitions", of.size()},
          {"spread", nullptr}};
}

ManyActorsFigures Measure(ManyActorsOptions options) {
  const shoal::launch::ScratchFolder folder;
  options.folder = folder.path();
  const ManyActorsFigures figures = shoal::bench::MeasureManyActors(options);
  std::cerr << fmt::format(
      "{} actors: started in {:.2f} s, all found {:.2f} s later; {:.0f} transitions/s, {:.1f} us "
      "of the replay each, {:.1f} us of an actor\n",
      figures.actors, figures.start_seconds, figures.found_seconds, figures.transitions_per_second,
      figures.replay_us_per_transition, figures.actor_us_per_transition);
  return figures;
}

// Adds both rows of each number of actors, which are measured in turn.
void MeasureCounts(const std::vector<int>& counts, int repetitions, ManyActorsOptions options,
                   nlohmann::ordered_json* rows) {
  std::vector<Repetitions> all(counts.size());
  for (int r = 0; r < repetitions; ++r) {
    for (size_t i = 0; i < counts.size(); ++i) {
      options.actors = counts[i];
      all[i].push_back(Measure(options));
    }
  }
  const auto sixteen = std::ranges::find(counts, 16);
  const Repetitions& few =
      all[sixteen == counts.end() ? 0 : static_cast<size_t>(sixteen - counts.begin())];
  for (const Repetitions& of : all) {
    rows->push_back(WithDetails(CostRow(of, few), of));
    rows->push_back(FoundRow(of));
  }
}

int Run(int argc, char** argv) {
  std::vector<int> counts{4, 16, 64, 256};
  ManyActorsOptions options;
  int repetitions = 3;
  bool real = false, fake = false;
  std::string python;
  CLI::App app("Measures a replay server under many actor processes, and real actors.",
               "shoal-bench-actors");
  shoal::AddVersion(&app);
  app.add_option("--actors", counts, "numbers of actor processes")->check(CLI::Range(1, 1024));
  app.add_option("--steps-per-second", options.steps_per_second, "of each actor")
      ->check(CLI::Range(1.0, 1e5));
  app.add_option("--seconds", options.seconds, "measured for each number and repetition")
      ->check(CLI::Range(1.0, 600.0));
  app.add_option("--repetitions", repetitions, "of all; the median counts")
      ->check(CLI::Range(1, 100));
  auto* only_real = app.add_flag("--real", real, "real actors alone");
  app.add_flag("--fake", fake, "actors that cost nothing but time alone")->excludes(only_real);
  app.add_option("--environments-of", python,
                 "instead, what Shoal adds to an env step of Python: an interpreter that has the "
                 "packages shoal_rl and gymnasium")
      ->excludes(only_real);
  if (const auto exit_code = shoal::ParseCommandLine(&app, argc, argv)) return *exit_code;
  options.programs = shoal::launch::ProgramFolder();
  shoal::InstallStopSignals();  // an interrupted one takes its processes and files with it

  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  if (!python.empty()) {
    for (auto& row : shoal::bench::HostedActorRows(options, python, repetitions)) {
      rows.push_back(std::move(row));
    }
  }
  if (!real && python.empty()) MeasureCounts(counts, repetitions, options, &rows);
  if (!fake && python.empty()) {
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
