// A training actor process: steps environments, publishes their records on credit, takes the newest
// weights between steps.
#pragma once

#include <cstdint>
#include <filesystem>

#include "common/dds/reach.h"

namespace shoal::actor {

// Runs until the coordinator ends the run or SIGTERM; returns the exit code: 0 when everything made
// was reported stored, 1 when the coordinator vanished or records were left. Throws Error at
// start-up.
int RunTrainingActor(const std::filesystem::path& run, uint32_t id, const dds::Reach& reach);

}  // namespace shoal::actor
