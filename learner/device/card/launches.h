// SPDX-License-Identifier: Apache-2.0
// Launches of kernels, which nvcc compiles.
#pragma once

#include <cuda_runtime_api.h>

#include "learner/device/card/forward_kernels.h"
#include "learner/device/card/map_kernels.h"
#include "learner/device/card/plain_convolutions.h"
#include "learner/device/card/weight_kernels.h"
#include "learner/device/kernels/kernels.h"

namespace shoal::learner::device {

// Throws Error (kDevice) unless a launch succeeded. Defined in a file of its own, because nvcc does
// not compile fmt's headers.
void RequireLaunched(cudaError_t status);

// Launches one kernel on the stream. Throws Error (kDevice).
void Launch(const kernels::Kernel& kernel, cudaStream_t stream);
void Launch(const kernels::AddBias& kernel, cudaStream_t stream);
void Launch(const kernels::AddBiasToMap& kernel, cudaStream_t stream);
void Launch(const kernels::WidenToF32& kernel, cudaStream_t stream);
void Launch(const kernels::ConvolveForward& kernel, cudaStream_t stream);
void Launch(const kernels::ConvolveForwardByTiles& kernel, cudaStream_t stream);
void Launch(const kernels::ConvolveData& kernel, cudaStream_t stream);
void Launch(const kernels::ConvolveWeights& kernel, cudaStream_t stream);
void Launch(const kernels::ConvolveWeightsByTiles& kernel, cudaStream_t stream);
void Launch(const kernels::AddWeightParts& kernel, cudaStream_t stream);

}  // namespace shoal::learner::device
