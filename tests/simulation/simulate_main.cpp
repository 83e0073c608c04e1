// SPDX-License-Identifier: Apache-2.0
// shoal-simulate: simulated runs with faults drawn from seeds.
#include <fmt/core.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "common/base/clock.h"
#include "common/base/command_line.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/main_guard.h"
#include "tests/simulation/simulated_run.h"

namespace shoal::simulation {
namespace {

struct Options {
  uint64_t seed = 1, count = 1;
  bool trace = false, faultless = false;
};

// Prints what was wrong. False when something was.
bool RunSeed(const Blueprint& blueprint, uint64_t seed, const Options& options) {
  const std::filesystem::path folder = MakeFreshFolder("shoal-simulate-", "/dev/shm");
  const std::vector<Fault> faults =
      options.faultless ? std::vector<Fault>() : DrawFaults(seed, blueprint.run.config);
  const Outcome outcome = Simulate(blueprint, seed, faults, folder / "run");
  if (options.trace || !outcome.good()) {
    for (const Fault& fault : faults) fmt::print("  {}\n", fault.Text());
    fmt::print("{}", outcome.log);
    for (const std::string& violation : outcome.violations) fmt::print("  ! {}\n", violation);
  }
  if (options.trace || !outcome.good() || options.count == 1) {
    fmt::print("seed {}: {}, {:.1f} simulated s, {} switches, trace {:016x}\n", seed,
               outcome.good() ? outcome.exit : "FAILED", outcome.seconds, outcome.switches,
               outcome.trace);
  }
  std::filesystem::remove_all(folder);
  std::fflush(stdout);
  return outcome.good();
}

// Each seed in a child, whose memory goes with it.
bool RunSeedInChild(const Blueprint& blueprint, uint64_t seed, const Options& options) {
  const pid_t child = fork();
  if (child == 0) {
    const int code = GuardBody(
        "shoal-simulate", [&] { return RunSeed(blueprint, seed, options) ? 0 : 1; },
        [](const std::string& line) { fmt::print("{}\n", line); });
    std::fflush(stdout);
    _exit(code);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status)) fmt::print("seed {}: FAILED by signal {}\n", seed, WTERMSIG(status));
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

int Run(int argc, char** argv) {
  Options options;
  CLI::App app("Simulated runs with faults drawn from seeds.", "shoal-simulate");
  app.add_option("--seed", options.seed, "first seed");
  app.add_option("--count", options.count, "seeds");
  app.add_flag("--trace", options.trace, "print what happened");
  app.add_flag("--faultless", options.faultless, "no faults");
  if (const auto exit_code = ParseCommandLine(&app, argc, argv)) return *exit_code;
  const Blueprint blueprint = MakeBlueprint();
  const SteadyTime start = Now();
  uint64_t bad = 0;
  for (uint64_t seed = options.seed; seed < options.seed + options.count; ++seed) {
    if (!RunSeedInChild(blueprint, seed, options)) ++bad;
  }
  fmt::print("{} of {} seeds failed, {:.1f} s\n", bad, options.count, SecondsSince(start));
  return bad == 0 ? 0 : 1;
}

}  // namespace
}  // namespace shoal::simulation

int main(int argc, char** argv) {
  return shoal::GuardMain("shoal-simulate", [&] { return shoal::simulation::Run(argc, argv); });
}
