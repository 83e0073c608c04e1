// SPDX-License-Identifier: Apache-2.0
// Threads that copy the frames of a batch beside the service's own thread (replay.threads).
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/base/mutex.h"
#include "common/base/thread_group.h"

namespace shoal::replay {

// The number of threads for the next second. `share`: part of the service's time that drawing and
// copying batches by `threads` threads took in the last second. One more thread if `share` is above
// one half; one fewer if the remaining threads would need less than 0.4. At most `most`, which is
// at least 1.
int GatherThreadsFor(double share, int threads, int most);

// Called by one thread. The threads sleep between batches.
class GatherThreads {
 public:
  explicit GatherThreads(int threads = 1) { Resize(threads); }
  ~GatherThreads() { Resize(1); }
  GatherThreads(const GatherThreads&) = delete;
  GatherThreads& operator=(const GatherThreads&) = delete;

  // Sets the number of threads, including the thread that calls Run.
  void Resize(int threads);
  int threads() const { return static_cast<int>(helpers_.size()) + 1; }

  // RunParts (batch_gather.h). `part` must not throw.
  void Run(int parts, const std::function<void(int part)>& part);

 private:
  // Runs parts of the present job that no thread has taken yet, until none are left.
  void TakeParts();
  void Serve();

  Mutex mutex_;
  ConditionVariable changed_;  // a job begins or ends, or the threads shall exit
  const std::function<void(int)>* job_ SHOAL_GUARDED_BY(mutex_) = nullptr;
  uint64_t jobs_ SHOAL_GUARDED_BY(mutex_) = 0;  // so far
  int busy_ SHOAL_GUARDED_BY(mutex_) = 0;       // helpers that may still work on the job
  bool leaving_ SHOAL_GUARDED_BY(mutex_) = false;
  int parts_ = 0;              // of the job; set before it is announced
  std::atomic<int> taken_{0};  // parts that a thread has taken
  std::vector<Thread> helpers_;
};

}  // namespace shoal::replay
