// SPDX-License-Identifier: Apache-2.0
// Errors of the values of drawn samples, which the replay turns into priorities. The ids of a batch
// are kept until the outcome of its update is known.
//
// The rows of a transition's copies (Eq. 15) have one sample; its error is the mean of its rows'
// errors.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "learner/batch_stream.h"

namespace shoal::learner {

// One thread.
class SampleErrorCollector {
 public:
  // `copies`: consecutive rows of a sample.
  explicit SampleErrorCollector(int copies) : copies_(size_t(copies)) {}

  // Keeps the ids of a batch whose update begins.
  void OnBatch(const Batch& batch);
  // The errors of the oldest batch that was kept, from the errors (B) of its rows. CHECKs that
  // there is such a batch with as many rows.
  SampleErrors TakeOldest(std::span<const float> errors);

 private:
  const size_t copies_;
  std::deque<SampleErrors> waiting_;  // without errors, oldest first
};

}  // namespace shoal::learner
