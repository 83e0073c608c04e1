// SPDX-License-Identifier: Apache-2.0
// Loops on the threads that oneDNN's primitives use (GNU OpenMP's pool).
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>

#include "common/base/held_signals.h"

namespace shoal::nn {

// Number of threads of networks that the calling thread builds from now on; 1 before SetThreads.
int Threads();

// Sets the pool's size for the calling thread during this object's lifetime. A network must run
// with the same pool size as at its construction, because the primitives divide their work during
// construction.
//
// Meanwhile signals wait for the calling thread, and always for the threads of a pool that starts
// in a scope: compute only in scopes, as Op::Run checks. The products of oneDNN on processors
// without AVX-512 move the stack pointer into a buffer on the heap (jit_avx_gemm_f32), and the
// frame of a signal handler would overwrite the memory before it.
class ThreadScope {
 public:
  explicit ThreadScope(int threads);
  ~ThreadScope();
  ThreadScope(const ThreadScope&) = delete;
  ThreadScope& operator=(const ThreadScope&) = delete;

 private:
  const HeldSignals held_;
  int former_;
};

// Whether the calling thread is in a ThreadScope.
bool InThreadScope();

// Splits [0, n) into one contiguous range for each thread of the current scope and runs body(begin,
// end) for each range. Returns after all ranges are done. The ranges depend only on n and on the
// number of threads. The body must not throw.
void ParallelFor(int n, const std::function<void(int begin, int end)>& body);

// Splits an array of n values over the threads and runs body(first, count) for each part. Parts
// consist of whole blocks, so that no thread is used for a few values only.
template <class Body>
void ParallelForValues(int64_t n, const Body& body) {
  constexpr int64_t kBlock = 1 << 14;
  ParallelFor(int((n + kBlock - 1) / kBlock), [&](int begin, int end) {
    const int64_t first = begin * kBlock;
    body(first, std::min(n, end * kBlock) - first);
  });
}

}  // namespace shoal::nn
