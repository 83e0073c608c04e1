// From the DDS receive threads to the service thread: chunks copied into pooled buffers, and batch
// requests. Everything is bounded; what does not fit is dropped and counted, and its sender sends
// it again.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "common/base/clock.h"
#include "common/base/mutex.h"
#include "common/wire/messages.h"

namespace shoal::replay {

// A chunk with memory of its own, aligned to 8.
struct PooledChunk {
  TransitionChunk chunk;  // chunk.payload views `words`
  std::vector<uint64_t> words;
  SteadyTime arrived{};
};

class ServiceInbox {
 public:
  static constexpr size_t kMaxRequests = 256;

  // `chunk_bytes`: largest payload. `max_chunks`: buffers at most, allocated when first needed.
  ServiceInbox(uint64_t spec_hash, uint64_t chunk_bytes, size_t max_chunks);

  // Receive threads. Never block for long: one lock, one copy outside of it. The payload of a chunk
  // of another spec or larger than chunk_bytes is left out.
  void OnChunk(const TransitionChunk& chunk);
  void OnRequest(const SampleRequest& request);
  // Any thread: makes a waiting or the next Wait() return.
  void Wake();

  struct Arrivals {
    std::deque<std::unique_ptr<PooledChunk>> chunks;
    std::deque<SampleRequest> requests;
  };
  // Service thread: everything that arrived, in order; waits for it, or Wake(), until `deadline`.
  Arrivals Wait(SteadyTime deadline);
  // Service thread: gives a buffer back.
  void Release(std::unique_ptr<PooledChunk> chunk);
  void SetMaxChunks(size_t max_chunks);

  // Waiting chunks and requests; what was dropped since construction.
  size_t Depth() const;
  uint64_t DroppedChunks() const;
  uint64_t DroppedRequests() const;

 private:
  // A free buffer, or nullptr and a drop counted.
  std::unique_ptr<PooledChunk> TakeBuffer();

  const uint64_t spec_hash_;
  const size_t chunk_words_;
  mutable Mutex mutex_;
  ConditionVariable arrived_;
  Arrivals waiting_ SHOAL_GUARDED_BY(mutex_);
  std::vector<std::unique_ptr<PooledChunk>> free_ SHOAL_GUARDED_BY(mutex_);
  size_t max_chunks_ SHOAL_GUARDED_BY(mutex_);
  size_t chunks_ SHOAL_GUARDED_BY(mutex_) = 0;  // buffers there are, wherever they are
  bool woken_ SHOAL_GUARDED_BY(mutex_) = false;
  uint64_t dropped_chunks_ SHOAL_GUARDED_BY(mutex_) = 0;
  uint64_t dropped_requests_ SHOAL_GUARDED_BY(mutex_) = 0;
};

}  // namespace shoal::replay
