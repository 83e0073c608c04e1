// SPDX-License-Identifier: Apache-2.0
// Samples in the order in which they were written: those that a reader has not taken yet, or those
// that a writer keeps for late joiners. keep_last = n keeps the last n of each writer and key.
//
// Threads: none; the exchange's mutex guards it. Cost: O(log keys) for each call.
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
  // 0: keeps all.
  explicit SampleQueue(int32_t keep_last) : keep_last_(keep_last) {}

  // Appends the sample. Returns the one that it pushes out: the oldest of its writer and key, if
  // keep_last of them were here; else null.
  SharedSample Push(SharedSample sample);
  // Removes and returns the oldest sample; null when there is none.
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
  // For keep_last > 0: where the samples of a writer and key are, the oldest first; never empty.
  std::map<WriterAndKey, std::deque<Samples::iterator>> places_;
};

}  // namespace shoal::link
