// SPDX-License-Identifier: Apache-2.0
// Queue from the DDS receive threads to the service thread. It contains chunks, copied into pooled
// buffers, and batch requests. The number of chunks and of requests is bounded. Messages beyond
// these bounds are dropped and counted; the senders send them again.
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

  // `chunk_bytes`: largest payload. `max_chunks`: largest number of buffers; a buffer is allocated
  // at its first use.
  ServiceInbox(uint64_t spec_hash, uint64_t chunk_bytes, size_t max_chunks)
      : pool_(spec_hash, chunk_bytes, max_chunks) {}

  // The receive threads call these two functions, which hold a lock briefly and copy without the
  // lock. The payload of a chunk is not copied if the chunk has another spec or is larger than
  // chunk_bytes.
  void OnChunk(const TransitionChunk& chunk);
  void OnRequest(const SampleRequest& request);
  // Makes the present Wait() return or, if no thread is in Wait(), the next Wait(). Any thread.
  void Wake();

  struct Arrivals {
    std::deque<std::unique_ptr<PooledChunk>> chunks;
    std::deque<SampleRequest> requests;
  };
  // Service thread: waits until `deadline` for an arrival or Wake(), and returns all messages that
  // arrived, in order.
  Arrivals Wait(SteadyTime deadline);
  // Service thread: returns a buffer to the pool.
  void Release(std::unique_ptr<PooledChunk> chunk) { pool_.Release(std::move(chunk)); }
  void SetMaxChunks(size_t max_chunks) { pool_.SetMaxChunks(max_chunks); }

  // Number of waiting chunks and requests.
  size_t Depth() const;
  // Number of messages that were dropped since construction.
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
