// SPDX-License-Identifier: Apache-2.0
// The form of kernels, so that one source runs on a card and on the host.
//
// A kernel is a trivially copyable struct. Its members are the arguments: sizes, and pointers into
// the device's memory. It has
//
//   static constexpr int kThreads    threads of a block
//   struct Shared                    memory that the threads of a block share
//   int blocks() const               blocks of a launch
//   template <class Block> SHOAL_KERNEL void Run(Block& block, Shared& shared) const
//
// Run computes one block as a sequence of phases: block.Threads(body) runs body(thread) for all
// threads of the block, and the next phase begins when all of them have finished. On a card the
// threads run in parallel and a phase ends with __syncthreads() (launch.cuh); on the host they run
// in turn (host_block.h). Rules:
//
//   - Code between phases runs in every thread of a card, so it only reads, and all threads take
//     the same path.
//   - Within a phase, no thread reads what another thread writes.
//   - Blocks do not wait for each other. Block::FinishesLast selects the block that continues alone
//     when all blocks of its group have written their results.
//   - Sums have a fixed order (reduce.h), so a kernel repeats its results bit for bit. Atomic
//     operations count blocks and never add numbers.
//
// Values of one thread that several phases use are in Block::Private<T>, one T for each thread.
//
// The 32 threads of a warp can multiply matrices of bf16 numbers together (tensor cores): in a
// phase block.Warps(body), body(warp) runs once for each warp, and uses
//
//   Block::Rows     16 rows of 16 bf16 numbers, read from shared memory by Block::ReadRows(row_of):
//                   row_of(k) is the address of row k, whose halves are aligned to 16 bytes; or
//                   by Block::ReadColumns(half_of): half_of(m, h) is the address of the numbers
//                   8 h to 8 h + 7 of column m, aligned to 16 bytes
//   Block::Tile     (16, 16) sums in f32: Clear(); AddProduct(a, b): sums[m][n] += sum over k of
//                   a[k][m] b[k][n]; ForEachPair(body): body(m, n, sums[m][n], sums[m][n + 1]) for
//                   all even n
//   Block::PerWarp<T>   one T for each warp, for several phases
#pragma once

#include <cstdint>

#ifdef __CUDACC__
#define SHOAL_KERNEL __device__ inline
#define SHOAL_EVERYWHERE __host__ __device__ constexpr
#define SHOAL_UNROLL _Pragma("unroll")  // so that an array that the loop indexes is in registers
#else
#define SHOAL_KERNEL inline
#define SHOAL_EVERYWHERE constexpr
#define SHOAL_UNROLL
#endif

namespace shoal::learner::kernels {

// Quotient, rounded up.
SHOAL_EVERYWHERE int64_t CeilDivide(int64_t n, int64_t by) { return (n + by - 1) / by; }

// Work on n independent elements: each block computes kElementsOfBlock of them.
constexpr int kElementThreads = 256;
constexpr int kWarpThreads = 32;
constexpr int kElementsOfBlock = 1024;
SHOAL_EVERYWHERE int BlocksForElements(int64_t n) { return int(CeilDivide(n, kElementsOfBlock)); }

// Runs body(i) for the elements of block `index` in one phase. Neighbouring threads compute
// neighbouring elements.
template <class Block, class Body>
SHOAL_KERNEL void ForElements(Block& block, int64_t index, int64_t n, const Body& body) {
  block.Threads([&](int thread) {
    const int64_t first = index * kElementsOfBlock;
    const int64_t end = first + kElementsOfBlock < n ? first + kElementsOfBlock : n;
    for (int64_t i = first + thread; i < end; i += kElementThreads) body(i);
  });
}

// Runs body(i) for all elements in the phase of a kernel that has one block.
template <int kThreads, class Body>
SHOAL_KERNEL void ForAll(int thread, int64_t n, const Body& body) {
  for (int64_t i = thread; i < n; i += kThreads) body(i);
}

// A kernel without shared memory.
struct NoShared {};

}  // namespace shoal::learner::kernels
