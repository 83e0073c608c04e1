// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/service_inbox.h"

#include <utility>

namespace shoal::replay {

void ServiceInbox::OnChunk(const TransitionChunk& chunk) {
  std::unique_ptr<PooledChunk> buffer = pool_.Copy(chunk);
  if (!buffer) return;
  const MutexLock lock(mutex_);
  waiting_.chunks.push_back(std::move(buffer));
  arrived_.NotifyOne();
}

void ServiceInbox::OnRequest(const SampleRequest& request) {
  const MutexLock lock(mutex_);
  if (waiting_.requests.size() >= kMaxRequests) {
    ++dropped_requests_;
    return;
  }
  waiting_.requests.push_back(request);
  arrived_.NotifyOne();
}

void ServiceInbox::Wake() {
  const MutexLock lock(mutex_);
  woken_ = true;
  arrived_.NotifyOne();
}

ServiceInbox::Arrivals ServiceInbox::Wait(SteadyTime deadline) {
  const MutexLock lock(mutex_);
  while (!woken_ && waiting_.chunks.empty() && waiting_.requests.empty()) {
    if (!arrived_.WaitUntil(mutex_, deadline)) break;
  }
  woken_ = false;
  return std::exchange(waiting_, {});
}

size_t ServiceInbox::Depth() const {
  const MutexLock lock(mutex_);
  return waiting_.chunks.size() + waiting_.requests.size();
}

uint64_t ServiceInbox::DroppedRequests() const {
  const MutexLock lock(mutex_);
  return dropped_requests_;
}

}  // namespace shoal::replay
