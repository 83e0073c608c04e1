// SPDX-License-Identifier: Apache-2.0
#include "actor/sending/chunk_window.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "common/base/check.h"

namespace shoal::actor {

ChunkWindow::ChunkWindow(const Options& options)
    : options_(options),
      stored_(options.records_before),
      // The replay discovers this actor by its first records, so some may be sent before any
      // credit.
      allowed_(options.records_before + options.first_records),
      last_sequence_(options.records_before) {
  CHECK(options.chunks >= 3 && options.chunk_records >= 1 && options.record_bytes > 0);
  CHECK(options.first_records > 0);
  for (int i = 0; i < options.chunks; ++i) {
    Chunk chunk;
    chunk.bytes.resize(static_cast<size_t>(options.chunk_records) * options.record_bytes);
    free_.push_back(std::move(chunk));
  }
}

size_t ChunkWindow::Room() const {
  const size_t per_chunk = static_cast<size_t>(options_.chunk_records);
  const bool open = !kept_.empty() && !kept_.back().closed;
  const size_t memory = free_.size() * per_chunk + (open ? per_chunk - kept_.back().count : 0);
  return std::min<size_t>(memory, CreditLeft());
}

uint8_t* ChunkWindow::BeginRecord() {
  if (kept_.empty() || kept_.back().closed) {
    CHECK(!free_.empty()) << "no room";
    kept_.push_back(std::move(free_.back()));
    free_.pop_back();
    Chunk& fresh = kept_.back();
    fresh.count = 0;
    fresh.closed = fresh.sent_before = false;
  }
  Chunk& open = kept_.back();
  uint8_t* record = open.bytes.data() + static_cast<size_t>(open.count) * options_.record_bytes;
  std::memset(record, 0, static_cast<size_t>(options_.record_bytes));
  return record;
}

void ChunkWindow::EndRecord(uint64_t sequence) {
  CHECK(sequence == last_sequence_ + 1) << sequence << " after " << last_sequence_;
  CHECK(!kept_.empty() && !kept_.back().closed) << "no record was begun";
  last_sequence_ = sequence;
  Chunk& open = kept_.back();
  if (open.count == 0) open.first_sequence = sequence;
  if (++open.count == static_cast<uint32_t>(options_.chunk_records)) open.closed = true;
}

void ChunkWindow::Flush() {
  if (!kept_.empty() && kept_.back().count > 0) kept_.back().closed = true;
}

uint64_t ChunkWindow::FirstKept() const {
  const bool any = !kept_.empty() && kept_.front().count > 0;
  return any ? kept_.front().first_sequence : last_sequence_ + 1;
}

std::optional<TransitionChunk> ChunkWindow::NextToSend() const {
  TransitionChunk message;
  message.spec_hash = options_.spec_hash;
  message.actor = options_.actor;
  message.session = options_.session;
  if (position_due_) {
    // A message without records tells a restarted replay where the kept records begin.
    message.first_sequence = FirstKept();
    return message;
  }
  if (unsent_from_ >= kept_.size()) return std::nullopt;
  const Chunk& chunk = kept_[unsent_from_];
  if (!chunk.closed || chunk.first_sequence + chunk.count - 1 > allowed_) return std::nullopt;
  message.count = chunk.count;
  message.first_sequence = chunk.first_sequence;
  message.payload = {chunk.bytes.data(), static_cast<size_t>(chunk.count) * options_.record_bytes};
  return message;
}

void ChunkWindow::MarkSent() {
  if (std::exchange(position_due_, false)) return;
  CHECK(unsent_from_ < kept_.size());
  Chunk& chunk = kept_[unsent_from_++];
  if (chunk.sent_before) resent_records_ += chunk.count;
  chunk.sent_before = true;
}

void ChunkWindow::OnCredit(const Credit& credit) {
  if (credit.actor != options_.actor || credit.session != options_.session) return;
  if (credit.replay_session < replay_session_) return;  // a late credit of an earlier replay
  if (credit.replay_session > replay_session_) {
    const bool restarted = replay_session_ != 0;
    replay_session_ = credit.replay_session;
    if (restarted) Rewind();
  }
  allowed_ = credit.allowed;
  stored_ = std::max(stored_, std::min(credit.stored, last_sequence_));
  while (!kept_.empty() && kept_.front().closed &&
         kept_.front().first_sequence + kept_.front().count - 1 <= stored_) {
    free_.push_back(std::move(kept_.front()));
    kept_.pop_front();
    if (unsent_from_ > 0) --unsent_from_;
  }
}

std::optional<int64_t> ChunkWindow::OldestUnstoredNs() const {
  if (Outstanding() == 0 || kept_.empty()) return std::nullopt;
  const Chunk& oldest = kept_.front();
  const uint64_t dealt_with =
      stored_ < oldest.first_sequence ? 0 : stored_ + 1 - oldest.first_sequence;
  CHECK(dealt_with < oldest.count) << "a chunk that is stored was kept";
  return RecordLayout::Header(oldest.bytes.data() +
                              dealt_with * static_cast<size_t>(options_.record_bytes))
      .time_ns;
}

void ChunkWindow::Rewind() {
  unsent_from_ = 0;
  position_due_ = FirstKept() > 1;  // nothing to announce before the first record was stored
}

}  // namespace shoal::actor
