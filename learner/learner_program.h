// SPDX-License-Identifier: Apache-2.0
// The learner of a run, put together: networks, batches and weights over DDS, checkpoints.
#pragma once

#include <filesystem>

#include "common/dds/reach.h"

namespace shoal::learner {

// Trains run `run` from its newest checkpoint, or from the start, until it is told to stop; `argv`
// is the program's, for OpenMP (openmp_environment.h). Returns the exit code: 0 stopped in order, 1
// the coordinator is gone. Throws Error.
int RunLearner(const std::filesystem::path& run, const dds::Reach& reach, char** argv);

}  // namespace shoal::learner
