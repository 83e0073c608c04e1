// SPDX-License-Identifier: Apache-2.0
// Queue from the DDS receive threads to the service thread: chunks, copied into pooled buffers, and
// batch requests. Everything is bounded. Messages that do not fit are dropped and counted; their
// sender sends them again.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <utility>

#include "common/base/clock.h"
#include "common/base/mutex.h"
#include "common/intake/chunk_pool.h"
#include "common/wire/messages.h"

namespace shoal::replay {

class ServiceInbox {
 public:
  static constexpr size_t kMaxRequests = 256;

  // `chunk_bytes`: largest payload. `max_chunks`: buffers at most, allocated when first needed.
  ServiceInbox(uint64_t spec_hash, uint64_t chunk_bytes, size_t max_chunks)
      : pool_(spec_hash, chunk_bytes, max_chunks) {}

  // The receive threads call both functions, which take one lock briefly and copy outside of it.
  // The payload of a chunk is omitted if the chunk has another spec or is larger than chunk_bytes.
  void OnChunk(const TransitionChunk& chunk);
  void OnRequest(const SampleRequest& request);
  // Any thread: makes the present Wait(), or else the next one, return.
  void Wake();

  struct Arrivals {
    std::deque<std::unique_ptr<PooledChunk>> chunks;
    std::deque<SampleRequest> requests;
  };
  // Service thread: returns everything that arrived, in order. Waits for an arrival or Wake(),
  // until `deadline`.
  Arrivals Wait(SteadyTime deadline);
  // Service thread: returns a buffer to the pool.
  void Release(std::unique_ptr<PooledChunk> chunk) { pool_.Release(std::move(chunk)); }
  void SetMaxChunks(size_t max_chunks) { pool_.SetMaxChunks(max_chunks); }

  // Depth: waiting chunks and requests. The others: messages dropped since construction.
  size_t Depth() const;
  uint64_t DroppedChunks() const { return pool_.Dropped(); }
  uint64_t DroppedRequests() const;

 private:
  ChunkPool pool_;
  mutable Mutex mutex_;
  ConditionVariable arrived_;
  Arrivals waiting_ SHOAL_GUARDED_BY(mutex_);
  bool woken_ SHOAL_GUARDED_BY(mutex_) = false;
  uint64_t dropped_requests_ SHOAL_GUARDED_BY(mutex_) = 0;
};

}  // namespace shoal::replay
