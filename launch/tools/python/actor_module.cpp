// SPDX-License-Identifier: Apache-2.0
// shoal_rl._actor: the actor program, with environments of Python (shoal_rl/actor.py). It links
// neither MuJoCo nor OSMesa.
//
// Threads: the program runs without Python's lock, which each call of an environment takes, so that
// threads of the user's code run meanwhile.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "actor/evaluation/hosted_view.h"
#include "actor/hosted/hosted_environment.h"
#include "actor/program.h"
#include "common/base/bounded_json.h"
#include "common/base/build_info.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/main_guard.h"
#include "common/base/random.h"
#include "common/base/stop.h"
#include "common/config/spec_mismatch.h"
#include "common/dds/bus.h"
#include "launch/tools/python/python_environment.h"

namespace py = pybind11;

namespace shoal::python {
namespace {

constexpr std::chrono::seconds kTrial{2};  // of an environment that is described
constexpr size_t kMostTrialSteps = 1000, kRepeatedSteps = 50;

EnvironmentOrder OrderOf(const Config& config, bool picture) {
  return {.id = config.env.id,
          .kwargs = config.env.kwargs.json,
          .folder = config.env.folder,
          .task = config.task,
          .picture = picture};
}

// The environments of this process.
class Hosting {
 public:
  // `pictures`: the environments will be asked for pictures.
  Hosting(EnvironmentOpener opener, bool pictures)
      : opener_(std::move(opener)), pictures_(pictures) {}

  actor::ActorParts Parts() {
    return {
        .add_tasks = [](const RunConfig& run) { tasks::AddEnvironmentTask(run.spec.environment); },
        .environments = {.make = [this](const RunConfig& run,
                                        int count) { return Make(run, count); },
                         .with_task = RefuseOtherTask,
                         .view = [this](const RunConfig&,
                                        const auto& options) { return View(options); }},
        .describe = [this](const Config& config) { return Describe(config); }};
  }

 private:
  CallWatch& WatchOf(const Config& config) {
    if (!watch_) {
      watch_.emplace(config.env.id, std::chrono::duration<double>(config.env.step_timeout));
    }
    return *watch_;
  }

  std::unique_ptr<hosted::HostedEnvironment> MakeOne(const RunConfig& run, bool picture) {
    const py::gil_scoped_acquire lock;
    OpenedEnvironment opened = Open(opener_, OrderOf(run.config, picture));
    opened.description.TakeFindings(
        tasks::EnvironmentFromJson(ParseBoundedJson<nlohmann::json>(run.spec.environment)));
    auto description = opened.description;
    auto environment = std::make_unique<hosted::HostedEnvironment>(
        std::move(description), run.config,
        std::make_unique<PythonEnvironment>(std::move(opened), WatchOf(run.config)));
    if (environment->spec().Hash() != run.spec.Hash()) {
      throw RuntimeError("{}", SpecMismatch(run, environment->spec()));
    }
    return environment;
  }

  std::vector<std::unique_ptr<worlds::Environment>> Make(const RunConfig& run, int count) {
    std::vector<std::unique_ptr<worlds::Environment>> environments;
    for (int i = 0; i < count; ++i) {
      auto one = MakeOne(run, pictures_);
      newest_ = one.get();
      environments.push_back(std::move(one));
    }
    InstallStopSignals();  // the user's code may have taken them
    return environments;
  }

  std::unique_ptr<actor::EpisodeView> View(const actor::FrameRecorder::Options& options) {
    return std::make_unique<actor::HostedView>(newest_->raw(), options.height, options.width);
  }

  static RunConfig RefuseOtherTask(const RunConfig& run, const std::string& task) {
    throw UsageError("--task {}: a policy of environment {} plays that environment alone", task,
                     run.config.env.id);
  }

  // Opens the environment, finds its goal, plays until its first episode or a few seconds are over,
  // and plays the beginning again.
  nlohmann::ordered_json Describe(const Config& config) {
    std::unique_ptr<PythonEnvironment> environment;
    tasks::EnvironmentDescription description;
    {
      const py::gil_scoped_acquire lock;
      OpenedEnvironment opened = Open(opener_, OrderOf(config, /*picture=*/false));
      FindGoal(opener_, &opened);
      description = opened.description;
      environment = std::make_unique<PythonEnvironment>(std::move(opened), WatchOf(config));
    }
    const auto seed = static_cast<uint64_t>(config.seed);
    const SteadyTime start = Now();
    const Played first = Play(*environment, description, seed, kMostTrialSteps, start + kTrial);
    const std::chrono::duration<double> seconds = Now() - start;
    const auto count = std::min(first.moments.size(), size_t{kRepeatedSteps});
    const Played again = Play(*environment, description, seed, count, Now() + 2 * kTrial);
    description.success = first.success;
    nlohmann::ordered_json trial{
        {"steps", first.moments.size() - 1},
        {"step_microseconds",
         1e6 * seconds.count() / double(std::max<size_t>(1, first.moments.size() - 1))},
        {"repeated_steps", again.moments.size() - 1}};
    const auto [was, is] = std::ranges::mismatch(first.moments, again.moments);
    if (is != again.moments.end()) trial["differs_at"] = is - again.moments.begin();
    return {{"environment", ToJson(description)}, {"trial", trial}, {"version", BuildVersion()}};
  }

  // The course of an episode: hashes of the first observation, then of each step.
  struct Played {
    std::vector<uint64_t> moments;
    bool success = false;  // a step said whether it succeeds
  };

  static uint64_t HashOf(const hosted::RawEnvironment& environment,
                         const tasks::EnvironmentDescription& description) {
    uint64_t hash = 0;
    for (size_t i = 0; i < description.observation.size(); ++i) {
      const tasks::ArraySpace& space = description.observation[i];
      const size_t bytes = size_t(space.size()) * tasks::BytesOf(space.type);
      hash = HashWords({hash, HashBytes(environment.observation()[i], bytes)});
    }
    return hash;
  }

  // Random actions of a seed until the episode ends, `most` moments are played or `end` has come.
  static Played Play(hosted::RawEnvironment& environment,
                     const tasks::EnvironmentDescription& description, uint64_t seed, size_t most,
                     SteadyTime end) {
    Random random(seed);
    environment.Reset(static_cast<uint32_t>(seed & 0x7fffffffU));
    Played played{.moments = {HashOf(environment, description)}};
    std::vector<double> action(size_t(description.action.size()));
    while (played.moments.size() < most && Now() < end) {
      for (size_t i = 0; i < action.size(); ++i) {
        const double low = description.action.Low(int(i)), high = description.action.High(int(i));
        action[i] = low + random.Uniform() * (high - low);
      }
      const hosted::RawStep step = environment.Step(action);
      played.success = played.success || step.success.has_value();
      played.moments.push_back(
          HashWords({HashOf(environment, description), std::bit_cast<uint64_t>(step.reward),
                     uint64_t{step.terminated}, uint64_t{step.truncated}}));
      if (step.terminated || step.truncated) break;
    }
    return played;
  }

  const EnvironmentOpener opener_;
  const bool pictures_;
  std::optional<CallWatch> watch_;
  hosted::HostedEnvironment* newest_ = nullptr;  // borrowed
};

int Run(std::vector<std::string> words, const py::object& open, const py::object& refused) {
  dds::TuneMalloc();
  Hosting hosting({.open = open, .refused = refused}, std::ranges::count(words, "--frames") > 0);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const py::gil_scoped_release unlocked;
  return GuardMain("shoal-actor", [&] {
    return actor::RunActorProgram(int(words.size()), arguments.data(), hosting.Parts());
  });
}

}  // namespace
}  // namespace shoal::python

PYBIND11_MODULE(_actor, module) {
  module.attr("__version__") = shoal::BuildVersion();
  module.def("run", &shoal::python::Run, py::arg("words"), py::arg("open"), py::arg("refused"));
}
