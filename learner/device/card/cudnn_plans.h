// SPDX-License-Identifier: Apache-2.0
// Convolutions of maps in bf16 by cuDNN's graph interface, without bias and ReLU. Only engines of
// cuDNN with a fixed order of sums are used.
#pragma once

#include <cuda_runtime_api.h>
#include <cudnn.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>

#include "learner/device/card/cudnn_descriptor.h"
#include "learner/device/commands.h"

namespace shoal::learner::device {

enum class ConvolutionKind : int32_t { kForward, kData, kWeights };

// An engine of cuDNN for one shape.
struct CudnnPlan {
  int64_t workspace_bytes;
  bool narrow;  // the gradient of the weights is bf16
  Descriptor plan;
};

// Not movable. One thread.
class CudnnPlans {
 public:
  // Plans run on the stream. Throws Error (kDevice), like the functions below.
  explicit CudnnPlans(cudaStream_t stream);
  ~CudnnPlans();
  CudnnPlans(const CudnnPlans&) = delete;
  CudnnPlans& operator=(const CudnnPlans&) = delete;

  // The plan for a shape, chosen at the first call, which must precede a capture. Null if the shape
  // is in f32, or if cuDNN has no engine; a line on stderr says once that there is no engine.
  const CudnnPlan* Of(ConvolutionKind kind, const ConvolutionShape& shape);
  // input and output: maps, or their gradients. weight: or its gradient.
  void Run(const CudnnPlan& plan, const void* input, const void* weight, const void* output,
           void* workspace) const;

 private:
  using Key = std::array<int32_t, 11>;

  std::unique_ptr<CudnnPlan> Choose(ConvolutionKind kind, const ConvolutionShape& shape) const;

  cudnnHandle_t handle_ = nullptr;
  std::map<Key, std::unique_ptr<CudnnPlan>> plans_;
};

}  // namespace shoal::learner::device
