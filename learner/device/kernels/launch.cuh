// SPDX-License-Identifier: Apache-2.0
// Runs kernels on a card (frame.h). Only sources for nvcc include this header.
#pragma once

#include <cuda_runtime.h>

#include "learner/device/kernels/frame.h"

namespace shoal::learner::kernels {

// The block of the calling thread.
class CardBlock {
 public:
  __device__ int index() const { return int(blockIdx.x); }
  __device__ int count() const { return int(gridDim.x); }

  template <class Body>
  __device__ void Threads(const Body& body) const {
    body(int(threadIdx.x));
    __syncthreads();
  }

  // The calling thread's T.
  template <class T>
  class Private {
   public:
    __device__ explicit Private(const CardBlock&) {}
    __device__ T& operator()(int) { return value_; }

   private:
    T value_;
  };

  // See HostBlock. The first fence makes this block's results visible before it is counted; the
  // second one orders the count before reads of the other blocks' results.
  __device__ bool FinishesLast(int32_t* counter, int blocks) const {
    __shared__ bool last;
    __threadfence();
    __syncthreads();
    if (threadIdx.x == 0) {
      last = atomicAdd(counter, 1) == blocks - 1;
      if (last) *counter = 0;
    }
    __syncthreads();
    const bool is_last = last;
    __threadfence();
    __syncthreads();
    return is_last;
  }
};

template <class Kernel>
__global__ void __launch_bounds__(Kernel::kThreads)
    RunKernel(const __grid_constant__ Kernel kernel) {
  __shared__ typename Kernel::Shared shared;
  CardBlock block;
  kernel.Run(block, shared);
}

// Launches a kernel. Errors are those of the CUDA runtime's cudaGetLastError.
template <class Kernel>
void LaunchOnCard(const Kernel& kernel, cudaStream_t stream) {
  const int blocks = kernel.blocks();
  if (blocks > 0) RunKernel<<<unsigned(blocks), Kernel::kThreads, 0, stream>>>(kernel);
}

}  // namespace shoal::learner::kernels
