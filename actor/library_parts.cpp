// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "actor/hosted/environment_library.h"
#include "actor/hosted_parts.h"
#include "common/tasks/environment_description.h"

namespace shoal::actor {
namespace {

OpenedEnvironment OpenOfLibrary(const Config& config, Purpose) {
  auto environment = hosted::MakeOwnEnvironment(config.env.id, config.env.kwargs.json);
  tasks::EnvironmentDescription description = environment->Describe();
  description.id = config.env.id;
  description.task = config.task;
  // The way through JSON applies the same checks as to a description from another program.
  return {tasks::EnvironmentFromJson(ToJson(description)), std::move(environment)};
}

bool IsOfLibrary(const Config& config) { return !tasks::LibraryOf(config.env.id).empty(); }

}  // namespace

ActorParts LibraryParts(bool shows) { return HostedParts(OpenOfLibrary, shows); }

ActorParts WorldOrLibraryParts(bool shows) {
  const ActorParts worlds = WorldParts(), library = LibraryParts(shows);
  const auto parts_of = [=](const Config& config) {
    return IsOfLibrary(config) ? library : worlds;
  };
  return {.add_tasks = [=](const RunConfig& run) { parts_of(run.config).add_tasks(run); },
          .environments = {.make =
                               [=](const RunConfig& run, int count) {
                                 return parts_of(run.config).environments.make(run, count);
                               },
                           .with_task =
                               [=](const RunConfig& run, const std::string& task) {
                                 return parts_of(run.config).environments.with_task(run, task);
                               },
                           .view =
                               [=](const RunConfig& run, const FrameRecorder::Options& options) {
                                 return parts_of(run.config).environments.view(run, options);
                               }},
          .describe = [=](const Config& config) { return parts_of(config).describe(config); }};
}

}  // namespace shoal::actor
