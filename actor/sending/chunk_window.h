// SPDX-License-Identifier: Apache-2.0
// The sending side of the flow control between actor and replay. Records are written into chunks.
// Chunks are sent within the window that the replay allows and kept until the replay acknowledges
// them. Chunks are resent to a new replay session, or if no acknowledgement arrives for a while.
// The replay drops duplicates. A resend begins with a chunk without records, which reports the
// first retained sequence: if the previous replay lost its memory, the new replay must not wait for
// records that no longer exist.
//
// Owns the chunk memory: `chunks` chunks of `chunk_records` records, allocated once. Independent of
// DDS and clocks. One thread.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "actor/sending/record_sink.h"
#include "common/spec/record.h"
#include "common/wire/messages.h"

namespace shoal::actor {

class ChunkWindow final : public RecordSink {
 public:
  struct Options {
    uint64_t spec_hash = 0;
    uint32_t actor = 0;
    uint64_t session = 0;
    int record_bytes = 0;
    int chunk_records = 0;        // records per chunk at most
    int chunks = 0;               // >= 3: the chunks of the replay's window, and the open chunk
    uint64_t first_records = 0;   // records that may be made before the first credit
    uint64_t records_before = 0;  // earlier records of a continued session; all are stored
  };
  explicit ChunkWindow(const Options& options);

  size_t Room() const override;
  uint8_t* BeginRecord() override;
  void EndRecord(uint64_t sequence) override;
  // Makes the open chunk, if it holds records, ready to be sent.
  void Flush();

  // The next unsent chunk within the window. Valid until the next call of a non-const member.
  std::optional<TransitionChunk> NextToSend() const;
  void MarkSent();

  // Applies the replay's newest credit, which may be lower than the previous credit. Credits of
  // other actors and sessions are ignored.
  void OnCredit(const Credit& credit);
  // Begins a resend of everything that is not stored, for example if no credit has arrived for too
  // long. The first chunk has no records and reports where the resend begins.
  void Rewind();

  uint64_t stored() const { return stored_; }
  // Number of records that the actor may still begin and send with the present credit.
  uint64_t CreditLeft() const { return allowed_ > last_sequence_ ? allowed_ - last_sequence_ : 0; }
  // Timestamp (time_ns) of the oldest unacknowledged record; empty if all records are acknowledged.
  std::optional<int64_t> OldestUnstoredNs() const;
  // Records begun in this session and not yet acknowledged.
  uint64_t Outstanding() const { return last_sequence_ - stored_; }
  bool HasUnstoredSent() const { return unsent_from_ > 0; }
  uint64_t resent_records() const { return resent_records_; }

 private:
  // The sequence of the oldest retained record; if no record is retained, the next sequence.
  uint64_t FirstKept() const;

  struct Chunk {
    std::vector<uint8_t> bytes;
    uint64_t first_sequence = 0;
    uint32_t count = 0;
    bool closed = false;
    bool sent_before = false;
  };

  Options options_;
  std::deque<Chunk> kept_;  // oldest first; the last chunk may be open
  std::vector<Chunk> free_;
  size_t unsent_from_ = 0;     // kept_[i] with i < unsent_from_ was sent in this replay session
  bool position_due_ = false;  // a chunk without records is sent next
  uint64_t stored_;
  uint64_t allowed_;  // highest sequence that may be made and sent
  uint64_t last_sequence_;
  uint64_t replay_session_ = 0;
  uint64_t resent_records_ = 0;
};

}  // namespace shoal::actor
