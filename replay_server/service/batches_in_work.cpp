// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/batches_in_work.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace shoal::replay {

void BatchesInWork::Add(BegunBatch batch) {
  const auto copies = std::make_shared<const FrameCopies>(std::move(batch.copies));
  const uint64_t job =
      threads_.Start(copies->parts(), [copies](int part) { copies->MakePart(part); });
  batches_.push_back({batch.batch, copies->oldest, job});
}

bool BatchesInWork::Has(uint64_t request) const {
  return std::ranges::any_of(
      batches_, [request](const Copied& c) { return c.batch.request.request == request; });
}

std::vector<DrawnBatch> BatchesInWork::TakeComplete() {
  std::vector<DrawnBatch> complete;
  std::erase_if(batches_, [&](const Copied& copied) {
    if (!threads_.Done(copied.job)) return false;
    complete.push_back(copied.batch);
    return true;
  });
  return complete;
}

void BatchesInWork::Finish() {
  if (!batches_.empty()) threads_.Finish(batches_.back().job);
}

void BatchesInWork::FinishReadersUpTo(uint64_t last) {
  for (const Copied& copied : batches_) {
    if (copied.oldest != 0 && copied.oldest <= last) threads_.Finish(copied.job);
  }
}

}  // namespace shoal::replay
