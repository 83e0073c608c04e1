// SPDX-License-Identifier: Apache-2.0
// The environments of one process.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "actor/worlds/environment.h"
#include "common/config/run_config.h"

namespace shoal::actor {

// Makes so many environments of the run.
using EnvironmentFactory =
    std::function<std::vector<std::unique_ptr<worlds::Environment>>(const RunConfig&, int)>;

// `count` environments sharing one render context. Throws Error naming both sides when what they
// observe is not what the run's config.json says.
std::vector<std::unique_ptr<worlds::Environment>> MakeEnvironments(const RunConfig& run, int count);

}  // namespace shoal::actor
