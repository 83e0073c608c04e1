// SPDX-License-Identifier: Apache-2.0
// shoal-bench-batches: cost of passing a batch from replay to learner, through shared memory and
// over the network of one host, as JSON (schema shoal-bench-1) on stdout. `./run bench-batches`.
// With --drawn: how many batches a second the replay server draws for a learner that does nothing
// else than request them, as one line.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/base/build_info.h"
#include "common/base/main_guard.h"
#include "launch/processes/scratch_folder.h"
#include "launch/record/machine.h"
#include "tests/benchmark/batch_handover.h"
#include "tests/benchmark/drawn_batches.h"

namespace {

using shoal::bench::HandoverFigures;
using shoal::bench::HandoverOptions;

double CpuPerGigabyte(const HandoverFigures& figures) {
  return (figures.replay_seconds + figures.learner_seconds) / figures.gigabytes;
}

// The repetition in the middle.
HandoverFigures Median(std::vector<HandoverFigures> all) {
  std::ranges::sort(all, {}, CpuPerGigabyte);
  return all[all.size() / 2];
}

// (Largest - smallest) / median of the ratios, pair by pair.
double Spread(const std::vector<HandoverFigures>& shared,
              const std::vector<HandoverFigures>& network) {
  std::vector<double> ratios;
  for (size_t i = 0; i < shared.size(); ++i) {
    ratios.push_back(CpuPerGigabyte(shared[i]) / CpuPerGigabyte(network[i]));
  }
  std::ranges::sort(ratios);
  return (ratios.back() - ratios.front()) / ratios[ratios.size() / 2];
}

nlohmann::ordered_json Row(const std::vector<HandoverFigures>& all_shared,
                           const std::vector<HandoverFigures>& all_network) {
  const HandoverFigures shared = Median(all_shared), network = Median(all_network);
  return {{"stage", "batches handed to a learner on the same host, beside the gather"},
          {"figure", CpuPerGigabyte(shared)},
          {"unit", "s of CPU per GB"},
          {"against", "over the network"},
          {"against_figure", CpuPerGigabyte(network)},
          {"ratio", CpuPerGigabyte(shared) / CpuPerGigabyte(network)},
          {"target", nullptr},
          {"at_most", 0.05},
          {"repetitions", all_shared.size()},
          {"spread", Spread(all_shared, all_network)},
          {"replay_seconds_per_gb", shared.replay_seconds / shared.gigabytes},
          {"learner_seconds_per_gb", shared.learner_seconds / shared.gigabytes},
          {"against_replay_seconds_per_gb", network.replay_seconds / network.gigabytes},
          {"against_learner_seconds_per_gb", network.learner_seconds / network.gigabytes}};
}

int MeasureRate(shoal::bench::DrawnOptions options) {
  const shoal::launch::ScratchFolder folder(std::filesystem::current_path());
  options.folder = folder.path();
  const shoal::bench::DrawnFigures figures = shoal::bench::MeasureDrawn(options);
  fmt::print(
      "{:.0f} batches/s; CPU per batch: replay {:.3f} ms, learner {:.3f} ms (batch {}, {} records, "
      "learner.request_credits={}, replay.threads={})\n",
      figures.batches_per_second, 1e3 * figures.replay_seconds, 1e3 * figures.learner_seconds,
      options.batch, options.records, options.credits, options.threads);
  return 0;
}

int Run(int argc, char** argv) {
  HandoverOptions options;
  shoal::bench::DrawnOptions drawn;
  bool draws = false;
  int repetitions = 3;
  CLI::App app("Measures what handing batches over costs.");
  app.add_option("--batch", options.batch, "of two 84x84 RGB cameras")->check(CLI::Range(1, 4096));
  app.add_option("--batches", options.batches, "handed over each time")
      ->check(CLI::Range(1, 100'000));
  app.add_option("--repetitions", repetitions, "of both ways in turn; the median counts")
      ->check(CLI::Range(1, 100));
  app.add_flag("--drawn", draws, "measure the rate of drawn batches instead; it takes:");
  app.add_option("--records", drawn.records, "of the ring")->check(CLI::Range(200, 1'000'000));
  app.add_option("--credits", drawn.credits, "learner.request_credits")->check(CLI::Range(1, 64));
  app.add_option("--threads", drawn.threads, "replay.threads")->check(CLI::Range(0, 64));
  app.add_option("--seconds", drawn.seconds, "of the measurement")->check(CLI::Range(0.1, 100.0));
  CLI11_PARSE(app, argc, argv);
  drawn.batch = options.batch;
  if (draws) return MeasureRate(drawn);
  std::vector<HandoverFigures> shared, network;
  for (int i = 0; i < repetitions; ++i) {
    for (const bool way : {true, false}) {
      options.shared = way;
      const HandoverFigures figures = shoal::bench::MeasureHandover(options);
      (way ? shared : network).push_back(figures);
      std::cerr << fmt::format("{}: {:.4f} s of CPU per GB (replay {:.4f}, learner {:.4f})\n",
                               way ? "shared memory" : "network", CpuPerGigabyte(figures),
                               figures.replay_seconds / figures.gigabytes,
                               figures.learner_seconds / figures.gigabytes);
    }
  }
  const nlohmann::ordered_json report{
      {"schema", "shoal-bench-1"},
      {"commit", shoal::BuildCommit()},
      {"machine", shoal::launch::DescribeMachine()},
      {"rows", nlohmann::ordered_json::array({Row(shared, network)})}};
  std::cout << report.dump(2) << std::endl;
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return shoal::GuardMain("shoal-bench-batches", [&] { return Run(argc, argv); });
}
