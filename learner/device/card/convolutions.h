// SPDX-License-Identifier: Apache-2.0
// Convolutions (commands.h) on a card. In bf16, by cuDNN's graph interface, with bias and ReLU in
// kernels of map_kernels.h; or, for the shapes for which they are faster, by kernels of
// forward_kernels.h and weight_kernels.h. In f32, by kernels of map_kernels.h, because cuDNN might
// use TF32.
//
// Only engines of cuDNN with a fixed order of sums are used. If cuDNN has no engine for a shape,
// the slower kernel of map_kernels.h computes it, and a line on stderr says so once.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "learner/device/card/cudnn_plans.h"
#include "learner/device/commands.h"

namespace shoal::learner::device {

class CudaConvolutions {
 public:
  explicit CudaConvolutions(cudaStream_t stream) : stream_(stream), plans_(stream) {}
  CudaConvolutions(const CudaConvolutions&) = delete;
  CudaConvolutions& operator=(const CudaConvolutions&) = delete;

  // Chooses an engine and returns the workspace that the command needs, in bytes. Call it before a
  // capture. Throws Error (kDevice).
  int64_t Prepare(const ConvolutionForward& command);
  int64_t Prepare(const ConvolutionData& command);
  int64_t Prepare(const ConvolutionWeights& command);
  // Submit the command to the stream of the constructor. Throw Error (kDevice).
  void Run(const ConvolutionForward& command, void* workspace);
  void Run(const ConvolutionData& command, void* workspace);
  void Run(const ConvolutionWeights& command, void* workspace);

 private:
  // Parts of the workspace of ConvolutionWeights, in bytes: cuDNN's, the gradient in bf16, parts of
  // sums, and counters.
  struct WeightsWorkspace {
    int64_t plan = 0, narrow = 0, sums = 0, counters = 0;
    int64_t total() const { return plan + narrow + sums + counters; }
  };
  WeightsWorkspace WorkspaceOf(const ConvolutionWeights& command);
  void RunByTiles(const ConvolutionWeights& command, void* workspace);
  void RunPlan(const CudnnPlan& plan, const ConvolutionWeights& command, void* workspace);

  const cudaStream_t stream_;
  CudnnPlans plans_;
};

}  // namespace shoal::learner::device
