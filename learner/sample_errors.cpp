// SPDX-License-Identifier: Apache-2.0
#include "learner/sample_errors.h"

#include <numeric>
#include <utility>

#include "common/base/check.h"

namespace shoal::learner {

void SampleErrorCollector::OnBatch(const Batch& batch) {
  SampleErrors& samples = waiting_.emplace_back();
  samples.request = batch.request;
  for (size_t row = 0; row < batch.view.rows(); row += copies_) {
    samples.ids.push_back(batch.view.id[row]);
  }
}

SampleErrors SampleErrorCollector::TakeOldest(std::span<const float> errors) {
  CHECK(!waiting_.empty() && errors.size() == waiting_.front().ids.size() * copies_)
      << errors.size() << " errors, " << waiting_.size() << " batches";
  SampleErrors samples = std::move(waiting_.front());
  waiting_.pop_front();
  for (size_t row = 0; row < errors.size(); row += copies_) {
    const auto of_sample = errors.subspan(row, copies_);
    const double sum = std::accumulate(of_sample.begin(), of_sample.end(), 0.0);
    samples.errors.push_back(float(sum / double(copies_)));
  }
  return samples;
}

}  // namespace shoal::learner
