// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/hosted_actors.h"

#include <fmt/core.h>

#include <chrono>

#include "actor/hosted/hosted_spec.h"
#include "common/base/bounded_json.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "launch/processes/actor_program.h"
#include "launch/processes/child_process.h"
#include "launch/processes/scratch_folder.h"
#include "launch/run/environment_choice.h"
#include "tests/benchmark/acting_cost.h"
#include "tests/benchmark/paired_timing.h"

namespace shoal::bench {
namespace {

constexpr std::chrono::seconds kOwnSteps{120};

struct Kind {
  const char* name;  // of the class in trivial_environment.py
  const char* what;  // is observed
  bool pixels;
  double at_most;  // microseconds
};
constexpr Kind kKinds[] = {{"State", "three numbers", false, 60},
                           {"Picture", "one 84x84 picture", true, 120}};

std::string Script() { return std::string(SHOAL_BENCH_SOURCES) + "/trivial_environment.py"; }

RunConfig RunOf(const Kind& kind, const std::string& python) {
  RunConfig run = UnlearnedRun(1);
  run.config.env.id = fmt::format("{}:{}", Script(), kind.name);
  run.config.env.python = python;
  run.config.observation.pixels = kind.pixels;
  run.config.observation.proprioception = true;
  run.config.exploration.random_steps = 0;  // acting from the first step on
  launch::CompleteEnvironmentKeys(&run.config);
  run.spec = hosted::SpecOf(launch::DescribeEnvironment(run.config).description, run.config);
  run.config.observation.cameras = run.spec.cameras;
  return run;
}

// CPU seconds of the environments' own steps, by class.
nlohmann::json OwnSteps(const std::string& python) {
  const launch::ScratchFolder folder;
  launch::ProcessSpec spec;
  spec.role = "python";
  spec.command = {python, Script()};
  spec.output = folder.path() / "answer";
  spec.errors = folder.path() / "errors";
  const auto status = launch::RunToEnd(spec, kOwnSteps, [] { return false; });
  if (!status || !status->Clean()) {
    throw RuntimeError("{} {}: {}", python, Script(), launch::LastLine(spec.errors));
  }
  return ParseBoundedJson<nlohmann::json>(ReadFile(spec.output));
}

struct Costs {
  std::vector<double> process, step, acting, added;  // microseconds, repetition by repetition

  void Add(double process_us, double step_us, double acting_us) {
    process.push_back(process_us);
    step.push_back(step_us);
    acting.push_back(acting_us);
    added.push_back(process_us - step_us - acting_us);
  }
};

nlohmann::ordered_json RowOf(const Kind& kind, const Costs& costs) {
  return {{"stage", fmt::format("added to an env step of Python that observes {}", kind.what)},
          {"figure", Median(costs.added)},
          {"unit", "us of one core"},
          {"against", "nothing"},
          {"against_figure", nullptr},
          {"ratio", nullptr},
          {"target", nullptr},
          {"at_most", kind.at_most},
          {"repetitions", costs.added.size()},
          {"spread", nullptr},
          {"process_us", Median(costs.process)},
          {"own_step_us", Median(costs.step)},
          {"acting_us", Median(costs.acting)}};
}

}  // namespace

std::vector<nlohmann::ordered_json> HostedActorRows(const ManyActorsOptions& options,
                                                    const std::string& python, int repetitions) {
  std::vector<nlohmann::ordered_json> rows;
  for (const Kind& kind : kKinds) {
    ManyActorsOptions one = options;
    one.actors = 1;
    one.run = RunOf(kind, python);
    one.weights = FirstWeights(*one.run);
    Costs costs;
    for (int i = 0; i < repetitions; ++i) {
      const launch::ScratchFolder folder;
      one.folder = folder.path();
      costs.Add(MeasureManyActors(one).actor_us_per_transition,
                1e6 * OwnSteps(python).at(kind.name).get<double>(),
                1e6 * InferCpuSeconds(*one.run, one.weights, options.seconds / 2));
      fmt::print(stderr, "{}: {:.1f} us of CPU an env step, its own {:.1f}, acting {:.1f}\n",
                 kind.name, costs.process.back(), costs.step.back(), costs.acting.back());
    }
    rows.push_back(RowOf(kind, costs));
  }
  return rows;
}

}  // namespace shoal::bench
