// SPDX-License-Identifier: Apache-2.0
// Loops on the threads that oneDNN's primitives use (GNU OpenMP's pool).
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>

namespace shoal::nn {

// Number of threads of networks that the calling thread builds from now on; 1 before SetThreads.
int Threads();

// Sets the pool's size for the calling thread during this object's lifetime. A network must be run
// with the size with which it was built, because its primitives partition their work when they are
// built.
class ThreadScope {
 public:
  explicit ThreadScope(int threads);
  ~ThreadScope();
  ThreadScope(const ThreadScope&) = delete;
  ThreadScope& operator=(const ThreadScope&) = delete;

 private:
  int former_;
};

// Splits [0, n) into one contiguous range per thread of the current scope and runs body(begin, end)
// on each; returns when all are done. Ranges depend on n and the number of threads only. The body
// must not throw.
void ParallelFor(int n, const std::function<void(int begin, int end)>& body);

// The same over an array of n values, in blocks large enough to be worth a thread: body(first,
// count).
template <class Body>
void ParallelForValues(int64_t n, const Body& body) {
  constexpr int64_t kBlock = 1 << 14;
  ParallelFor(int((n + kBlock - 1) / kBlock), [&](int begin, int end) {
    const int64_t first = begin * kBlock;
    body(first, std::min(n, end * kBlock) - first);
  });
}

}  // namespace shoal::nn
