// SPDX-License-Identifier: Apache-2.0
#include <variant>

#include "learner/device/card/launches.h"
#include "learner/device/kernels/launch.cuh"

namespace shoal::learner::device {
namespace {

template <class Kernel>
void LaunchOne(const Kernel& kernel, cudaStream_t stream) {
  kernels::LaunchOnCard(kernel, stream);
  RequireLaunched(cudaGetLastError());
}

}  // namespace

void Launch(const kernels::Kernel& kernel, cudaStream_t stream) {
  std::visit([stream](const auto& one) { LaunchOne(one, stream); }, kernel);
}
void Launch(const kernels::AddBias& kernel, cudaStream_t stream) { LaunchOne(kernel, stream); }
void Launch(const kernels::AddBiasToMap& kernel, cudaStream_t stream) { LaunchOne(kernel, stream); }
void Launch(const kernels::WidenToF32& kernel, cudaStream_t stream) { LaunchOne(kernel, stream); }
void Launch(const kernels::ConvolveForward& kernel, cudaStream_t stream) {
  LaunchOne(kernel, stream);
}
void Launch(const kernels::ConvolveForwardByTiles& kernel, cudaStream_t stream) {
  LaunchOne(kernel, stream);
}
void Launch(const kernels::ConvolveData& kernel, cudaStream_t stream) { LaunchOne(kernel, stream); }
void Launch(const kernels::ConvolveWeights& kernel, cudaStream_t stream) {
  LaunchOne(kernel, stream);
}
void Launch(const kernels::ConvolveWeightsByTiles& kernel, cudaStream_t stream) {
  LaunchOne(kernel, stream);
}
void Launch(const kernels::AddWeightParts& kernel, cudaStream_t stream) {
  LaunchOne(kernel, stream);
}

}  // namespace shoal::learner::device
