// SPDX-License-Identifier: Apache-2.0
// Threads that copy the frames of a batch together with the service's own thread (replay.threads).
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/base/mutex.h"
#include "common/base/thread_group.h"

namespace shoal::replay {

// Returns the number of threads for the next second. `share`: share of the last second in which the
// service drew and copied batches with `threads` threads. Returns one thread more if `share` is
// above 0.5, and one thread fewer if the share with this number would be below 0.4. The result is
// at most `most`, which must be at least 1.
int GatherThreadsFor(double share, int threads, int most);

// Only one thread may call the functions. The other threads sleep between batches.
class GatherThreads {
 public:
  explicit GatherThreads(int threads = 1) { Resize(threads); }
  ~GatherThreads() { Resize(1); }
  GatherThreads(const GatherThreads&) = delete;
  GatherThreads& operator=(const GatherThreads&) = delete;

  // Sets the number of threads, including the thread that calls Run.
  void Resize(int threads);
  int threads() const { return static_cast<int>(helpers_.size()) + 1; }

  // See RunParts (batch_gather.h). `part` must not throw.
  void Run(int parts, const std::function<void(int part)>& part);

 private:
  // Runs parts of the present job that no other thread has taken, until all parts are taken.
  void TakeParts();
  void Serve();

  Mutex mutex_;
  ConditionVariable changed_;  // notified when a job begins or ends, or when the threads must exit
  const std::function<void(int)>* job_ SHOAL_GUARDED_BY(mutex_) = nullptr;
  uint64_t jobs_ SHOAL_GUARDED_BY(mutex_) = 0;  // number of jobs so far
  int busy_ SHOAL_GUARDED_BY(mutex_) = 0;       // number of helpers that may still work on the job
  bool leaving_ SHOAL_GUARDED_BY(mutex_) = false;
  int parts_ = 0;              // number of parts of the job; set before the job is announced
  std::atomic<int> taken_{0};  // number of parts that threads have taken
  std::vector<Thread> helpers_;
};

}  // namespace shoal::replay
