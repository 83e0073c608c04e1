// SPDX-License-Identifier: Apache-2.0
// A training actor process: steps environments, publishes their records on credit, takes the newest
// weights between steps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "actor/acting/environments.h"
#include "common/dds/reach.h"

namespace shoal::actor {

// Makes so many environments of the run.
using EnvironmentFactory =
    std::function<std::vector<std::unique_ptr<worlds::Environment>>(const RunConfig&, int)>;

// Runs until the coordinator ends the run or SIGTERM; returns the exit code: 0 when everything made
// was reported stored, 1 when the coordinator vanished or records were left. Throws Error at
// start-up. `make`: the task's environments; tests of the transport bring cheaper ones.
int RunTrainingActor(const std::filesystem::path& run, uint32_t id, const dds::Reach& reach,
                     const EnvironmentFactory& make = MakeEnvironments);

}  // namespace shoal::actor
