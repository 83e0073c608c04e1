// SPDX-License-Identifier: Apache-2.0
#include "learner/device/card/cuda_error.h"
#include "learner/device/card/launches.h"

namespace shoal::learner::device {

void RequireLaunched(cudaError_t status) { Require(status, "launching a kernel"); }

}  // namespace shoal::learner::device
