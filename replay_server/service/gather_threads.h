// SPDX-License-Identifier: Apache-2.0
// Threads that copy the frames of batches together with the service's own thread (replay.threads).
//
// The copies of a batch are a job of independent parts. Several jobs may be open. Threads take the
// parts of the oldest job first, and go on with the next job without waiting for the end of this
// one.
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <vector>

#include "common/base/mutex.h"
#include "common/base/thread_group.h"

namespace shoal::replay {

// Returns the number of threads for the next interval. `share`: share of the last interval in which
// `threads` threads copied, on average over the threads. Returns more threads if `share` is above
// 0.5: the number with which the share would be 0.5. Returns one thread fewer if the share with
// this number would be below 0.4. The result is at most `most`, which must be at least 1.
int GatherThreadsFor(double share, int threads, int most);

// Only one thread, the owner, may call the public functions. The helpers sleep while there is
// nothing to copy.
class GatherThreads {
 public:
  // `on_done` is called on a helper each time it has run the last part of a job.
  explicit GatherThreads(int threads = 1, std::function<void()> on_done = nullptr);
  // Parts that no thread has taken are not run.
  ~GatherThreads() { Resize(1); }
  GatherThreads(const GatherThreads&) = delete;
  GatherThreads& operator=(const GatherThreads&) = delete;

  // Sets the number of threads, including the owner. Waits for the parts that helpers have taken.
  void Resize(int threads);
  int threads() const { return static_cast<int>(helpers_.size()) + 1; }

  // Opens a job: part(0) .. part(parts - 1) are run once each, on any threads and in any order.
  // `part` must not throw. Returns the number of the job. Numbers ascend from 1.
  uint64_t Start(int parts, std::function<void(int part)> part);
  // Whether all parts of the job have been run.
  bool Done(uint64_t job) const;
  // Whether parts wait for a thread.
  bool HasWork() const;
  // Runs a part on the calling thread; without helpers, all parts of a job. Returns whether parts
  // waited for a thread.
  bool Help();
  // Runs parts until those of this job and of all earlier jobs have been run.
  void Finish(uint64_t job);

  // Seconds for which the threads have run parts, summed over the threads.
  double seconds() const;

 private:
  struct Job {
    uint64_t number;
    int parts;
    int taken, run;  // numbers of parts
    std::function<void(int part)> part;
  };
  // The oldest job with a part that no thread has taken; nullptr if there is none.
  Job* Waiting() SHOAL_REQUIRES(mutex_);
  // Takes a part of the job and runs it. The lock is released while the part runs. Returns whether
  // this was the job's last part; the job is then gone.
  bool RunPart(Job* job) SHOAL_REQUIRES(mutex_);
  void Serve();

  const std::function<void()> on_done_;
  mutable Mutex mutex_;
  ConditionVariable work_;  // notified when parts wait, or when the helpers must exit
  ConditionVariable done_;  // notified when a job is gone
  std::list<Job> jobs_ SHOAL_GUARDED_BY(mutex_);   // ascending numbers; some part is not run yet
  uint64_t started_ SHOAL_GUARDED_BY(mutex_) = 0;  // number of jobs so far
  double seconds_ SHOAL_GUARDED_BY(mutex_) = 0;
  bool leaving_ SHOAL_GUARDED_BY(mutex_) = false;
  std::vector<Thread> helpers_;
};

}  // namespace shoal::replay
