// SPDX-License-Identifier: Apache-2.0
// Queue of samples in the order in which they were written: the samples that a reader has not taken
// yet, or the samples that a writer keeps for late joiners. If keep_last = n > 0, the queue keeps
// the last n samples of each writer and key.
//
// Threads: the exchange's mutex guards the queue. Cost: O(log keys) for each call.
#pragma once

#include <cstdint>
#include <deque>
#include <list>
#include <map>
#include <utility>

#include "common/link/stored_sample.h"

namespace shoal::link {

class SampleQueue {
 public:
  // 0: keeps all samples.
  explicit SampleQueue(int32_t keep_last) : keep_last_(keep_last) {}

  // Appends the sample. If the queue already held keep_last samples of the same writer and key,
  // removes and returns the oldest of them; otherwise returns null.
  SharedSample Push(SharedSample sample);
  // Removes and returns the oldest sample; null if the queue is empty.
  SharedSample Pop();
  // Removes and returns all samples, the oldest first.
  std::list<SharedSample> TakeAll();

  bool empty() const { return samples_.empty(); }
  // The oldest first.
  const std::list<SharedSample>& samples() const { return samples_; }

 private:
  using Samples = std::list<SharedSample>;
  using WriterAndKey = std::pair<const Unread*, Key>;

  static WriterAndKey Of(const StoredSample& sample) { return {&sample.unread(), sample.key()}; }

  const int32_t keep_last_;
  Samples samples_;
  // If keep_last > 0: positions of the samples of each writer and key, the oldest first. No list of
  // positions is empty.
  std::map<WriterAndKey, std::deque<Samples::iterator>> places_;
};

}  // namespace shoal::link
