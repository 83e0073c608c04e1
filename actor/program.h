// SPDX-License-Identifier: Apache-2.0
// The program `shoal-actor`. It has four uses: training actor, evaluation actor, evaluation of a
// checkpoint, and description of the observations of a configuration.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>

#include "actor/evaluation/evaluation_environments.h"
#include "common/config/run_config.h"

namespace shoal::actor {

// The parts of an actor that depend on the source of its environments.
struct ActorParts {
  // Registers the tasks of a configuration. Call it before threads start. Throws Error.
  std::function<void(const RunConfig&)> add_tasks;
  EvaluationEnvironments environments;
  // Makes the output of --describe for a configuration, as JSON. Throws Error.
  std::function<nlohmann::ordered_json(const Config&)> describe;
};

// Shoal's own worlds.
ActorParts WorldParts();

// Runs what the command line selects and returns the exit code. Throws Error (kUsage) if the
// command line is invalid, and the errors of the selected use.
int RunActorProgram(int argc, char** argv, const ActorParts& parts);

}  // namespace shoal::actor
