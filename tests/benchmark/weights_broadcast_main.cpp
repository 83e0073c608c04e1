// SPDX-License-Identifier: Apache-2.0
// shoal-bench-weights: cost of sending a learner's weights to the actors of its host, as JSON
// (schema shoal-bench-1) on stdout. `./run bench-weights`.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/base/build_info.h"
#include "common/base/command_line.h"
#include "common/base/main_guard.h"
#include "common/dds/bus.h"
#include "common/nn/precision.h"
#include "launch/record/machine.h"
#include "tests/benchmark/weights_broadcast.h"

namespace {

using shoal::bench::BroadcastFigures;
using shoal::bench::BroadcastOptions;

constexpr double kAtMost = 0.05;  // of a core, with 16 actors and two versions of `nature` a second

double Cost(const BroadcastFigures& figures) { return figures.learner + figures.actors; }

// Row of the median repetition.
nlohmann::ordered_json Row(const BroadcastOptions& options, std::vector<BroadcastFigures> all) {
  std::ranges::sort(all, {}, Cost);
  const BroadcastFigures& middle = all[all.size() / 2];
  return {{"stage", fmt::format("weights of {} to {} actors on the learner's host, {:g} a second",
                                options.encoder, options.actors, options.versions_per_second)},
          {"figure", Cost(middle)},
          {"unit", "of a core"},
          {"against", "the same processes without weights"},
          {"against_figure", middle.idle},
          {"ratio", nullptr},
          {"target", nullptr},
          {"at_most", kAtMost},
          {"repetitions", all.size()},
          {"spread", (Cost(all.back()) - Cost(all.front())) / Cost(middle)},
          {"learner_of_a_core", middle.learner},
          {"actors_of_a_core", middle.actors},
          {"versions_taken", middle.taken},
          {"version_bytes", middle.version_bytes}};
}

int Run(int argc, char** argv) {
  BroadcastOptions options;
  int repetitions = 3;
  CLI::App app("Measures what sending weights to the actors of a host costs.",
               "shoal-bench-weights");
  shoal::AddVersion(&app);
  app.add_option("--encoder", options.encoder, "of two 84x84 RGB cameras");
  app.add_option("--actors", options.actors, "on the learner's host")->check(CLI::Range(1, 256));
  app.add_option("--versions-per-second", options.versions_per_second, "that the learner sends")
      ->check(CLI::Range(0.1, 100.0));
  app.add_option("--seconds", options.seconds, "measured with weights, and as long without")
      ->check(CLI::Range(1.0, 600.0));
  app.add_option("--repetitions", repetitions, "the median counts")->check(CLI::Range(1, 100));
  if (const auto exit_code = shoal::ParseCommandLine(&app, argc, argv)) return *exit_code;
  shoal::nn::SetThreads(1);
  std::vector<BroadcastFigures> all;
  for (int i = 0; i < repetitions; ++i) {
    all.push_back(shoal::bench::MeasureBroadcast(options));
    const BroadcastFigures& figures = all.back();
    std::cerr << fmt::format(
        "{:.1f} % of a core (learner {:.1f}, actors {:.1f}) beside {:.1f} without weights; "
        "{:.0f} % of the versions taken, of {:.2f} MB\n",
        100 * Cost(figures), 100 * figures.learner, 100 * figures.actors, 100 * figures.idle,
        100 * figures.taken, 1e-6 * figures.version_bytes);
  }
  const nlohmann::ordered_json report{
      {"schema", "shoal-bench-1"},
      {"commit", shoal::BuildCommit()},
      {"machine", shoal::launch::DescribeMachine()},
      {"rows", nlohmann::ordered_json::array({Row(options, std::move(all))})}};
  std::cout << report.dump(2) << std::endl;
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  shoal::dds::TuneMalloc();
  return shoal::GuardMain("shoal-bench-weights", [&] { return Run(argc, argv); });
}
