// SPDX-License-Identifier: Apache-2.0
// The sending side of credited transitions: records are written into chunks, chunks are sent inside
// the window the replay allows, kept until it reports them stored, and sent again to a new replay
// session or when nothing was reported for a while. The replay drops duplicates. A resend begins
// with a chunk without records, which reports where the retained records begin: a replay whose
// predecessor lost its memory must not wait for records that are gone.
//
// Owns the chunk memory: `chunks` chunks of `chunk_records` records, allocated once. Knows nothing
// of DDS or clocks. One thread.
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
    int chunks = 0;               // >= 3: the replay's window and the open one
    uint64_t first_records = 0;   // records that may be made before the first credit
    uint64_t records_before = 0;  // of a session that goes on; all of them stored
  };
  explicit ChunkWindow(const Options& options);

  size_t Room() const override;
  uint8_t* BeginRecord() override;
  void EndRecord(uint64_t sequence) override;
  // Makes the open chunk, if it holds records, ready to be sent.
  void Flush();

  // The next chunk inside the window that was not sent yet. Valid until the next call of a
  // non-const member.
  std::optional<TransitionChunk> NextToSend() const;
  void MarkSent();

  // Takes the replay's newest credit, which may be lower than the last. Credits of other actors and
  // sessions are ignored.
  void OnCredit(const Credit& credit);
  // Begins a resend of everything that is not stored, for example when no credit has arrived for
  // too long. A chunk without records comes first, which reports where the resend begins.
  void Rewind();

  uint64_t stored() const { return stored_; }
  // Records that may still be begun and sent under the present credit.
  uint64_t CreditLeft() const { return allowed_ > last_sequence_ ? allowed_ - last_sequence_ : 0; }
  // When the oldest record not yet reported stored was made (its time_ns); empty when all are.
  std::optional<int64_t> OldestUnstoredNs() const;
  // Records begun in this session and not yet reported stored.
  uint64_t Outstanding() const { return last_sequence_ - stored_; }
  bool HasUnstoredSent() const { return unsent_from_ > 0; }
  uint64_t resent_records() const { return resent_records_; }

 private:
  // The oldest sequence that is still kept, or the next one to be made.
  uint64_t FirstKept() const;

  struct Chunk {
    std::vector<uint8_t> bytes;
    uint64_t first_sequence = 0;
    uint32_t count = 0;
    bool closed = false;
    bool sent_before = false;
  };

  Options options_;
  std::deque<Chunk> kept_;  // oldest first; the last one may be open
  std::vector<Chunk> free_;
  size_t unsent_from_ = 0;     // kept_[i], i < unsent_from_, was sent in this replay session
  bool position_due_ = false;  // the chunk without records comes next
  uint64_t stored_;
  uint64_t allowed_;  // highest sequence that may be made and sent
  uint64_t last_sequence_;
  uint64_t replay_session_ = 0;
  uint64_t resent_records_ = 0;
};

}  // namespace shoal::actor
