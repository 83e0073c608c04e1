// SPDX-License-Identifier: Apache-2.0
// `shoal train`: from options to the summary of a finished run.
#pragma once

#include "launch/run/train_options.h"

namespace shoal::launch {

// Returns the exit code. Throws Error.
int RunTraining(const TrainOptions& options);

}  // namespace shoal::launch
