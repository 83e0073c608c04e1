// SPDX-License-Identifier: Apache-2.0
// Pool of buffers for chunks. Receive threads of DDS copy chunks into the buffers, and another
// thread handles the chunks. Buffers are reused, and their number is bounded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/base/clock.h"
#include "common/base/mutex.h"
#include "common/wire/messages.h"

namespace shoal {

struct PooledChunk {
  TransitionChunk chunk;  // its payload is in `words`
  SteadyTime arrived{};
  std::vector<uint64_t> words;  // aligned to 8
};

// Any thread.
class ChunkPool {
 public:
  // The pool has at most `max_chunks` buffers of `chunk_bytes`. A buffer is allocated at its first
  // use.
  ChunkPool(uint64_t spec_hash, uint64_t chunk_bytes, size_t max_chunks);

  // Returns a copy of the chunk. If no buffer is free, counts a drop and returns null. The payload
  // is not copied if the chunk has another spec or is larger than chunk_bytes.
  std::unique_ptr<PooledChunk> Copy(const TransitionChunk& chunk);
  // Returns a buffer to the pool.
  void Release(std::unique_ptr<PooledChunk> chunk);
  void SetMaxChunks(size_t max_chunks);
  uint64_t Dropped() const;

 private:
  // Returns a free buffer. If there is none, counts a drop and returns null.
  std::unique_ptr<PooledChunk> TakeBuffer();

  const uint64_t spec_hash_;
  const size_t chunk_words_;
  mutable Mutex mutex_;
  std::vector<std::unique_ptr<PooledChunk>> free_ SHOAL_GUARDED_BY(mutex_);
  size_t max_chunks_ SHOAL_GUARDED_BY(mutex_);
  size_t chunks_ SHOAL_GUARDED_BY(mutex_) = 0;  // all buffers, free or in use
  uint64_t dropped_ SHOAL_GUARDED_BY(mutex_) = 0;
};

}  // namespace shoal
