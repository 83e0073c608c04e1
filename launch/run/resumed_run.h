// SPDX-License-Identifier: Apache-2.0
// `shoal train --resume`: the request of a run that continues from its folder.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "launch/processes/actor_program.h"
#include "launch/run/run_request.h"
#include "launch/run/train_options.h"

namespace shoal::launch {

// Locks and examines the run's folder, and prints missing and rebuilt files. With --print-config
// only the configuration and the hosts are resolved; with --dry-run no file is repaired. `describe`
// returns the observations of the actors' task; simulation tests replace this function. Throws
// Error.
RunRequest ResolveResumed(
    const TrainOptions& options,
    const std::function<ObservedWorld(const Config&)>& describe = DescribeObservations);

// The folder of credentials of the run's earlier sessions; empty if the run was not secured. Throws
// Error (usage) if a file is damaged.
std::string FormerSecurity(const std::filesystem::path& run);

}  // namespace shoal::launch
