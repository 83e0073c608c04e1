// SPDX-License-Identifier: Apache-2.0
// shoal-bench: ratios of one run, as JSON (schema shoal-bench-1) on stdout. `./run bench`.
#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "common/base/build_info.h"
#include "common/base/command_line.h"
#include "common/base/error.h"
#include "common/base/main_guard.h"
#include "common/base/stop.h"
#include "common/nn/precision.h"
#include "launch/record/machine.h"
#include "learner/openmp_environment.h"
#include "tests/benchmark/paired_timing.h"

namespace {

int Run(int argc, char** argv) {
  int repetitions = 7, threads = 1;
  double seconds = 0.5;
  std::string only;
  CLI::App app("Measures Shoal's stages, each against another way of doing the same.",
               "shoal-bench");
  shoal::AddVersion(&app);
  app.add_option("--repetitions", repetitions, "pairs per row")->check(CLI::Range(1, 1000));
  app.add_option("--seconds", seconds, "of each side of a pair")->check(CLI::Range(0.001, 60.0));
  app.add_option("--threads", threads, "of the networks")->check(CLI::Range(1, 1024));
  app.add_option("--only", only, "rows whose stage contains this text");
  if (const auto exit_code = shoal::ParseCommandLine(&app, argc, argv)) return *exit_code;
  shoal::nn::SetThreads(threads);

  shoal::learner::EnsurePassiveOpenMp(threads, argv);  // as shoal-learner does: no spinning threads
  shoal::InstallStopSignals();  // an interrupted one takes its processes and files with it

  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  bool whole = true, skipped = false;
  // A room at a time: what its rows hold is given back before the next.
  for (const auto make :
       {shoal::bench::ReplayPairings, shoal::bench::GatherPairings, shoal::bench::NetworkPairings,
        shoal::bench::UpdatePairings, shoal::bench::LearnerPairings, shoal::bench::ScalingPairings,
        shoal::bench::PolicyPairings, shoal::bench::TransportPairings, shoal::bench::WorldPairings,
        shoal::bench::FramePairings}) {
    for (const shoal::bench::Pairing& pairing : make()) {
      if (pairing.stage.find(only) == std::string::npos) continue;
      if (!pairing.skipped.empty()) {
        std::cerr << fmt::format("{}: skipped: {}\n", pairing.stage, pairing.skipped);
        skipped = true;
        continue;
      }
      std::cerr << fmt::format("measuring {} ...\n", pairing.stage);
      try {
        const auto row = shoal::bench::TimePair(pairing, repetitions, seconds);
        rows.push_back(ToJson(row));
        std::cerr << shoal::bench::LineOf(row) << "\n";
      } catch (const shoal::Error& e) {  // no room for a large ring: the other rows still count
        if (shoal::StopRequested()) throw;
        std::cerr << fmt::format("{}: not measured: {}\n", pairing.stage, e.what());
        whole = false;
      }
    }
  }
  if (rows.empty() && whole && !skipped)
    throw shoal::UsageError("no row's stage contains '{}'", only);
  const nlohmann::ordered_json report{{"schema", "shoal-bench-1"},
                                      {"commit", shoal::BuildCommit()},
                                      {"machine", shoal::launch::DescribeMachine()},
                                      {"network_threads", threads},
                                      {"rows", rows}};
  std::cout << report.dump(2) << std::endl;
  return whole ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return shoal::GuardMain("shoal-bench", [&] { return Run(argc, argv); });
}
