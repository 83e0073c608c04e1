#include "replay_server/service/service_inbox.h"

#include <cstring>
#include <utility>

namespace shoal::replay {

ServiceInbox::ServiceInbox(uint64_t spec_hash, uint64_t chunk_bytes, size_t max_chunks)
    : spec_hash_(spec_hash), chunk_words_((chunk_bytes + 7) / 8), max_chunks_(max_chunks) {}

std::unique_ptr<PooledChunk> ServiceInbox::TakeBuffer() {
  const MutexLock lock(mutex_);
  if (!free_.empty()) {
    std::unique_ptr<PooledChunk> buffer = std::move(free_.back());
    free_.pop_back();
    return buffer;
  }
  if (chunks_ >= max_chunks_) {
    ++dropped_chunks_;
    return nullptr;
  }
  ++chunks_;
  return std::make_unique<PooledChunk>();
}

void ServiceInbox::OnChunk(const TransitionChunk& chunk) {
  std::unique_ptr<PooledChunk> buffer = TakeBuffer();
  if (!buffer) return;
  buffer->words.resize(chunk_words_);
  buffer->chunk = chunk;
  buffer->chunk.payload = {};
  if (chunk.spec_hash == spec_hash_ && chunk.payload.size() <= chunk_words_ * 8) {
    auto* bytes = reinterpret_cast<uint8_t*>(buffer->words.data());
    if (!chunk.payload.empty()) std::memcpy(bytes, chunk.payload.data(), chunk.payload.size());
    buffer->chunk.payload = {bytes, chunk.payload.size()};
  }
  buffer->arrived = Now();
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

void ServiceInbox::Release(std::unique_ptr<PooledChunk> chunk) {
  const MutexLock lock(mutex_);
  free_.push_back(std::move(chunk));
}

void ServiceInbox::SetMaxChunks(size_t max_chunks) {
  const MutexLock lock(mutex_);
  max_chunks_ = max_chunks;
}

size_t ServiceInbox::Depth() const {
  const MutexLock lock(mutex_);
  return waiting_.chunks.size() + waiting_.requests.size();
}

uint64_t ServiceInbox::DroppedChunks() const {
  const MutexLock lock(mutex_);
  return dropped_chunks_;
}

uint64_t ServiceInbox::DroppedRequests() const {
  const MutexLock lock(mutex_);
  return dropped_requests_;
}

}  // namespace shoal::replay
