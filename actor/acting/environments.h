// SPDX-License-Identifier: Apache-2.0
// The environments of one process.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "actor/worlds/environment.h"
#include "common/config/run_config.h"

namespace shoal::actor {

// Makes the given number of environments of the run.
using EnvironmentFactory =
    std::function<std::vector<std::unique_ptr<worlds::Environment>>(const RunConfig&, int)>;

// Makes `count` environments that share one render context. If their observation spec differs from
// the spec in the run's config.json, throws Error naming both specs.
std::vector<std::unique_ptr<worlds::Environment>> MakeEnvironments(const RunConfig& run, int count);

}  // namespace shoal::actor
