// SPDX-License-Identifier: Apache-2.0
// shoal-actor: one program, four uses: training actor, evaluation actor, evaluation of a
// checkpoint, description of what the actors of a configuration observe.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>

#include "actor/evaluation/evaluation_environments.h"
#include "common/config/run_config.h"

namespace shoal::actor {

// The parts of an actor that depend on where the environments come from.
struct ActorParts {
  // Makes the tasks of a configuration known. Before threads. Throws Error.
  std::function<void(const RunConfig&)> add_tasks;
  EvaluationEnvironments environments;
  // The answer of --describe about a configuration, as JSON. Throws Error.
  std::function<nlohmann::ordered_json(const Config&)> describe;
};

// Shoal's own worlds.
ActorParts WorldParts();

// Runs what the command line asks for; returns the exit code. Throws Error (kUsage) on a command
// line that makes no sense, else as what was asked for does.
int RunActorProgram(int argc, char** argv, const ActorParts& parts);

}  // namespace shoal::actor
