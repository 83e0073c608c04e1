// SPDX-License-Identifier: Apache-2.0
// The evaluation actor process: plays whole episodes with each checkpoint the learner offers, on
// random streams of its own, and reports them to the coordinator. It never touches the replay.
#pragma once

#include <filesystem>

#include "common/dds/reach.h"

namespace shoal::actor {

// Runs until the coordinator ends the run or SIGTERM; returns the exit code. Throws Error at
// start-up.
int RunEvalActor(const std::filesystem::path& run, const dds::Reach& reach);

}  // namespace shoal::actor
