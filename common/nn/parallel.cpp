// SPDX-License-Identifier: Apache-2.0
#include "common/nn/parallel.h"

#include <algorithm>
#include <cstdint>

#include "common/base/check.h"
#include "common/nn/precision.h"

// The entry points of libgomp that a compiler's `#pragma omp parallel` calls. They are called
// directly, so that a compiler with another OpenMP runtime does not start a second pool beside
// oneDNN's.
extern "C" {
void GOMP_parallel(void (*body)(void*), void* data, unsigned threads, unsigned flags);
void omp_set_num_threads(int threads);
int omp_get_max_threads(void);
int omp_get_thread_num(void);
int omp_get_num_threads(void);
#ifdef __SANITIZE_THREAD__
// The thread sanitizer cannot see libgomp's fork and join; these functions tell it about both.
void __tsan_acquire(void* address);
void __tsan_release(void* address);
#endif
}

namespace shoal::nn {
namespace {

thread_local int threads_of_new_networks = 1;
thread_local int scopes = 0;  // of the calling thread

struct Loop {
  int n;
  const std::function<void(int, int)>* body;
  char fork = 0, join = 0;
};

void Acquire([[maybe_unused]] void* address) {
#ifdef __SANITIZE_THREAD__
  __tsan_acquire(address);
#endif
}

void Release([[maybe_unused]] void* address) {
#ifdef __SANITIZE_THREAD__
  __tsan_release(address);
#endif
}

void RunRange(void* data) {
  Loop* loop = static_cast<Loop*>(data);
  Acquire(&loop->fork);
  const int64_t thread = omp_get_thread_num(), threads = omp_get_num_threads();
  const int begin = int(loop->n * thread / threads), end = int(loop->n * (thread + 1) / threads);
  if (begin < end) (*loop->body)(begin, end);
  Release(&loop->join);
}

}  // namespace

int Threads() { return threads_of_new_networks; }

void SetThreads(int threads) {
  CHECK(threads > 0) << threads << " threads";
  threads_of_new_networks = threads;
}

ThreadScope::ThreadScope(int threads) : former_(omp_get_max_threads()) {
  omp_set_num_threads(threads);
  ++scopes;
}

ThreadScope::~ThreadScope() {
  --scopes;
  omp_set_num_threads(former_);
}

bool InThreadScope() { return scopes > 0; }

void ParallelFor(int n, const std::function<void(int begin, int end)>& body) {
  const int threads = std::min(n, omp_get_max_threads());
  if (threads <= 1) {
    if (n > 0) body(0, n);
    return;
  }
  Loop loop{n, &body};
  Release(&loop.fork);
  GOMP_parallel(RunRange, &loop, unsigned(threads), 0);
  Acquire(&loop.join);
}

}  // namespace shoal::nn
