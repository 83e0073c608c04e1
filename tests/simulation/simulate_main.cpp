// SPDX-License-Identifier: Apache-2.0
// shoal-simulate: simulated runs with faults drawn from seeds.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <vector>

#include "common/base/clock.h"
#include "common/base/command_line.h"
#include "common/base/error.h"
#include "common/base/main_guard.h"
#include "common/base/usable_cores.h"
#include "tests/simulation/child_runs.h"

namespace shoal::simulation {
namespace {

struct Options {
  uint64_t seed = 1, count = 1;
  int jobs = 0;
  double seconds = 0;
  int most_failures = 0;
  bool trace = false, no_shorten = false;
  std::vector<size_t> only;
};

class Simulations {
 public:
  explicit Simulations(const Options& options)
      : options_(options), blueprints_(MakeBlueprints()), start_(Now()), next_(options.seed) {}

  int Run() {
    RunInChildren(
        blueprints_, options_.jobs > 0 ? options_.jobs : UsableCores(), options_.trace,
        [this] { return Next(); }, [this](uint64_t seed) { return FaultsOf(seed); },
        [this](const ChildRun& run) { Take(run); });
    fmt::print("{} of {} seeds failed; {:.0f} simulated s in {:.1f} s\n", failed_.size(), done_,
               simulated_seconds_, SecondsSince(start_));
    return failed_.empty() ? 0 : 1;
  }

 private:
  uint64_t Next() {
    const bool late = options_.seconds > 0 && SecondsSince(start_) > options_.seconds;
    const bool enough = options_.most_failures > 0 &&
                        std::cmp_greater_equal(failed_.size(), options_.most_failures);
    if (late || enough || next_ >= options_.seed + options_.count) return 0;
    return next_++;
  }

  std::vector<Fault> FaultsOf(uint64_t seed) const {
    const std::vector<Fault> all = DrawFaults(seed, BlueprintOf(seed, blueprints_).run.config);
    if (options_.only.empty()) return all;
    std::vector<Fault> some;
    for (const size_t number : options_.only) {
      if (number < all.size()) some.push_back(all[number]);
    }
    return some;
  }

  void Take(const ChildRun& run) {
    ++done_;
    simulated_seconds_ += run.simulated_seconds;
    if (!run.good) failed_.push_back(run.seed);
    if (run.good && !options_.trace && options_.count > 1) return;
    fmt::print("{}{}\n", run.text, run.summary);
    if (!run.good) Explain(run.seed);
    std::fflush(stdout);
  }

  // How to repeat a failure, with the faults that it takes.
  void Explain(uint64_t seed) const {
    const std::vector<Fault> faults = FaultsOf(seed);
    if (options_.no_shorten || !options_.only.empty() || faults.size() < 2) {
      fmt::print("  again: shoal-simulate --seed {} --trace\n", seed);
      return;
    }
    const std::vector<size_t> kept = ShortenedSchedule(blueprints_, seed, faults);
    if (kept.empty()) {
      fmt::print("  again, it fails without a fault: shoal-simulate --seed {} --trace --only 99\n",
                 seed);
      return;
    }
    fmt::print(
        "  again, with the faults that it takes: shoal-simulate --seed {} --trace --only "
        "{}\n",
        seed, fmt::join(kept, " "));
    for (const size_t number : kept) fmt::print("    {}\n", faults[number].Text());
  }

  const Options options_;
  const std::vector<Blueprint> blueprints_;
  const SteadyTime start_;
  uint64_t next_, done_ = 0;
  double simulated_seconds_ = 0;
  std::vector<uint64_t> failed_;
};

int Run(int argc, char** argv) {
  Options options;
  CLI::App app("Simulated runs with faults drawn from seeds.", "shoal-simulate");
  app.add_option("--seed", options.seed, "first seed")->check(CLI::PositiveNumber);
  app.add_option("--count", options.count, "seeds");
  app.add_option("--jobs", options.jobs, "seeds at once; 0: one for each core");
  app.add_option("--seconds", options.seconds, "begin no seed after so long; 0: no limit");
  app.add_option("--most-failures", options.most_failures,
                 "begin no seed after so many have failed; 0: no limit");
  app.add_option("--only", options.only, "of a seed's faults those with these numbers");
  app.add_flag("--trace", options.trace, "print what happened");
  app.add_flag("--no-shorten", options.no_shorten,
               "do not look for the faults that a failure takes");
  if (const auto exit_code = ParseCommandLine(&app, argc, argv)) return *exit_code;
  return Simulations(options).Run();
}

}  // namespace
}  // namespace shoal::simulation

int main(int argc, char** argv) {
  return shoal::GuardMain("shoal-simulate", [&] { return shoal::simulation::Run(argc, argv); });
}
