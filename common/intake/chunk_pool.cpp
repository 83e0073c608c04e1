// SPDX-License-Identifier: Apache-2.0
#include "common/intake/chunk_pool.h"

#include <cstring>
#include <utility>

namespace shoal {

ChunkPool::ChunkPool(uint64_t spec_hash, uint64_t chunk_bytes, size_t max_chunks)
    : spec_hash_(spec_hash), chunk_words_((chunk_bytes + 7) / 8), max_chunks_(max_chunks) {}

std::unique_ptr<PooledChunk> ChunkPool::TakeBuffer() {
  const MutexLock lock(mutex_);
  if (!free_.empty()) {
    std::unique_ptr<PooledChunk> buffer = std::move(free_.back());
    free_.pop_back();
    return buffer;
  }
  if (chunks_ >= max_chunks_) {
    ++dropped_;
    return nullptr;
  }
  ++chunks_;
  return std::make_unique<PooledChunk>();
}

std::unique_ptr<PooledChunk> ChunkPool::Copy(const TransitionChunk& chunk) {
  std::unique_ptr<PooledChunk> buffer = TakeBuffer();
  if (!buffer) return nullptr;
  buffer->words.resize(chunk_words_);
  buffer->chunk = chunk;
  buffer->chunk.payload = {};
  if (chunk.spec_hash == spec_hash_ && chunk.payload.size() <= chunk_words_ * 8) {
    auto* bytes = reinterpret_cast<uint8_t*>(buffer->words.data());
    if (!chunk.payload.empty()) std::memcpy(bytes, chunk.payload.data(), chunk.payload.size());
    buffer->chunk.payload = {bytes, chunk.payload.size()};
  }
  buffer->arrived = Now();
  return buffer;
}

void ChunkPool::Release(std::unique_ptr<PooledChunk> chunk) {
  const MutexLock lock(mutex_);
  free_.push_back(std::move(chunk));
}

void ChunkPool::SetMaxChunks(size_t max_chunks) {
  const MutexLock lock(mutex_);
  max_chunks_ = max_chunks;
}

uint64_t ChunkPool::Dropped() const {
  const MutexLock lock(mutex_);
  return dropped_;
}

}  // namespace shoal
