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

// Makes `count` environments that share one render context. Throws Error naming both specs if the
// environments' observation spec differs from the one in the run's config.json.
std::vector<std::unique_ptr<worlds::Environment>> MakeEnvironments(const RunConfig& run, int count);

}  // namespace shoal::actor
