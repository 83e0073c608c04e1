// SPDX-License-Identifier: Apache-2.0
// `shoal train --resume`: the request of a run that goes on from its folder.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "launch/processes/actor_program.h"
#include "launch/run/run_request.h"
#include "launch/run/train_options.h"

namespace shoal::launch {

// Holds and examines the run's folder, and prints what of it is missing or rebuilt. With
// --print-config only the configuration and the hosts are resolved; with --dry-run nothing is
// repaired. `describe` asks the task what its actors observe; simulations have no task. Throws
// Error.
RunRequest ResolveResumed(
    const TrainOptions& options,
    const std::function<ObservedWorld(const Config&)>& describe = DescribeObservations);

// The folder of credentials of the run's earlier sessions; empty if they were not secured. Throws
// Error (usage) on a damaged file.
std::string FormerSecurity(const std::filesystem::path& run);

}  // namespace shoal::launch
