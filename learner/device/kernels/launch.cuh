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

  template <class Body>
  __device__ void Warps(const Body& body) const {
    body(int(threadIdx.x) / kWarpThreads);
    __syncthreads();
  }
  template <class T>
  using PerWarp = Private<T>;

  // Quarter q of a Rows has rows 8 (q / 2) and following, columns 8 (q % 2) and following. A thread
  // has two numbers of a column of each quarter: `ldmatrix` with `trans` distributes them as `mma`
  // (m16n8k16) expects its operands (PTX ISA, "Matrix fragments for mma.m16n8k16").
  struct Rows {
    uint32_t quarters[4];
  };
  template <class RowOf>
  __device__ static Rows ReadRows(const RowOf& row_of) {
    const int lane = int(threadIdx.x) % kWarpThreads, quarter = lane / 8;
    const uint16_t* row = row_of(quarter / 2 * 8 + lane % 8) + quarter % 2 * 8;
    Rows rows;
    asm volatile("ldmatrix.sync.aligned.m8n8.x4.trans.shared.b16 {%0, %1, %2, %3}, [%4];"
                 : "=r"(rows.quarters[0]), "=r"(rows.quarters[1]), "=r"(rows.quarters[2]),
                   "=r"(rows.quarters[3])
                 : "r"(uint32_t(__cvta_generic_to_shared(row)))
                 : "memory");
    return rows;
  }
  // Without `trans`, because the numbers of a column are adjacent.
  template <class HalfOf>
  __device__ static Rows ReadColumns(const HalfOf& half_of) {
    const int lane = int(threadIdx.x) % kWarpThreads, quarter = lane / 8;
    const uint16_t* half = half_of(quarter % 2 * 8 + lane % 8, quarter / 2);
    Rows rows;
    asm volatile("ldmatrix.sync.aligned.m8n8.x4.shared.b16 {%0, %1, %2, %3}, [%4];"
                 : "=r"(rows.quarters[0]), "=r"(rows.quarters[1]), "=r"(rows.quarters[2]),
                   "=r"(rows.quarters[3])
                 : "r"(uint32_t(__cvta_generic_to_shared(half)))
                 : "memory");
    return rows;
  }

  class Tile {
   public:
    __device__ void Clear() {
      for (float& sum : sums_) sum = 0;
    }
    __device__ void AddProduct(const Rows& a, const Rows& b) {
      Multiply(a, b.quarters[0], b.quarters[2], sums_);
      Multiply(a, b.quarters[1], b.quarters[3], sums_ + 4);
    }
    template <class Body>
    __device__ void ForEachPair(const Body& body) const {
      const int lane = int(threadIdx.x) % kWarpThreads, m = lane / 4, n = lane % 4 * 2;
      for (int i = 0; i < 4; ++i) {
        body(m + i % 2 * 8, n + i / 2 * 8, sums_[2 * i], sums_[2 * i + 1]);
      }
    }

   private:
    // Eight columns of the product.
    __device__ static void Multiply(const Rows& a, uint32_t b_low, uint32_t b_high, float* sums) {
      asm volatile(
          "mma.sync.aligned.m16n8k16.row.col.f32.bf16.bf16.f32 {%0, %1, %2, %3}, "
          "{%4, %5, %6, %7}, {%8, %9}, {%0, %1, %2, %3};"
          : "+f"(sums[0]), "+f"(sums[1]), "+f"(sums[2]), "+f"(sums[3])
          : "r"(a.quarters[0]), "r"(a.quarters[1]), "r"(a.quarters[2]), "r"(a.quarters[3]),
            "r"(b_low), "r"(b_high));
    }

    float sums_[8];
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
