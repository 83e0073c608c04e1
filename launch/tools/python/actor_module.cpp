// SPDX-License-Identifier: Apache-2.0 shoal_rl._actor: the actor program with Python environments
// (shoal_rl/actor.py). The module links neither MuJoCo nor OSMesa.
//
// Threads: the program releases Python's lock (GIL), so that threads of the user's code can run.
// Each call of an environment takes the lock.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "actor/hosted_parts.h"
#include "common/base/build_info.h"
#include "common/base/main_guard.h"
#include "common/dds/bus.h"
#include "launch/tools/python/python_environment.h"

namespace py = pybind11;

namespace shoal::python {
namespace {

// Opens the environments of this process.
class Opener {
 public:
  explicit Opener(EnvironmentOpener opener) : opener_(std::move(opener)) {}

  actor::OpenedEnvironment Open(const Config& config, actor::Purpose purpose) {
    const py::gil_scoped_acquire lock;
    OpenedEnvironment opened = python::Open(opener_, {.id = config.env.id,
                                                      .kwargs = config.env.kwargs.json,
                                                      .folder = config.env.folder,
                                                      .task = config.task,
                                                      .picture = purpose == actor::Purpose::kShow});
    if (purpose == actor::Purpose::kDescribe) FindGoal(opener_, &opened);
    tasks::EnvironmentDescription description = opened.description;
    return {std::move(description),
            std::make_unique<PythonEnvironment>(std::move(opened), WatchOf(config))};
  }

 private:
  CallWatch& WatchOf(const Config& config) {
    if (!watch_) {
      watch_.emplace(config.env.id, std::chrono::duration<double>(config.env.step_timeout));
    }
    return *watch_;
  }

  const EnvironmentOpener opener_;
  std::optional<CallWatch> watch_;
};

int Run(std::vector<std::string> words, const py::object& open, const py::object& refused) {
  dds::TuneMalloc();
  Opener opener({.open = open, .refused = refused});
  const actor::ActorParts parts = actor::HostedParts(
      [&](const Config& config, actor::Purpose purpose) { return opener.Open(config, purpose); },
      /*shows=*/std::ranges::count(words, "--frames") > 0);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const py::gil_scoped_release unlocked;
  return GuardMain("shoal-actor", [&] {
    return actor::RunActorProgram(int(words.size()), arguments.data(), parts);
  });
}

}  // namespace
}  // namespace shoal::python

PYBIND11_MODULE(_actor, module) {
  module.attr("__version__") = shoal::BuildVersion();
  module.def("run", &shoal::python::Run, py::arg("words"), py::arg("open"), py::arg("refused"));
}
