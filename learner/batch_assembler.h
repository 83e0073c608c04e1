// SPDX-License-Identifier: Apache-2.0
// Assembles batches from their parts, in its own buffers. Pure: no DDS, threads or clocks.
//
// A request for a batch has an id; the answer is a set of parts that together cover the batch's
// bytes (common/wire/batch_schema.h). Parts may arrive in any order, interleaved with other
// batches, and twice. If a request is answered again (it was sent again, or the replay has
// restarted), the new answer may hold other transitions. Parts of two answers are never mixed: the
// newer answer starts over. The replay's count of steps at the draw distinguishes answers.
//
// At most `buffers` batches are assembled at once. A part of any other batch is dropped; the caller
// counts it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/aligned_bytes.h"
#include "common/wire/messages.h"

namespace shoal::learner {

class BatchAssembler {
 public:
  enum class Verdict {
    kTaken,           // copied into its batch
    kStartedOver,     // taken, as the first part of another answer; the old answer was dropped
    kCompleted,       // taken, and its batch is whole now
    kDuplicate,       // was taken before
    kUnknownRequest,  // never expected, or already released
    kStaleSession,    // answers another learner session
    kWrongSpec,       // another observation spec
    kMalformed,       // sizes or offsets that no batch of this layout has
  };

  struct Assembled {
    uint8_t* data;  // aligned to 64; valid until Release
    uint64_t stored_records, stored_steps, unsampleable_steps;
  };

  // Batches of `batch_bytes` each; memory for `buffers` of them is allocated at once.
  BatchAssembler(uint64_t spec_hash, uint64_t learner_session, uint64_t batch_bytes, int buffers);

  // Takes a free buffer for `request`, which must not be in use. Returns false if no buffer is
  // free.
  bool Expect(uint64_t request);
  Verdict Add(const BatchPart& part);
  // Returns the batch of `request` if it is complete.
  std::optional<Assembled> TryGet(uint64_t request);
  // Frees the buffer of `request`.
  void Release(uint64_t request);

 private:
  struct Piece {
    uint64_t offset = 0, bytes = 0;  // bytes 0: not arrived yet
  };
  struct Slot {
    uint64_t request = 0;  // 0: free
    AlignedBytes memory;
    bool whole = false;
    uint64_t stored_records = 0, stored_steps = 0;  // distinguish answers
    uint64_t unsampleable_steps = 0;
    std::vector<Piece> pieces;  // per part
    uint32_t missing = 0;       // missing parts; 0 without pieces: no part has arrived
  };

  Slot* Find(uint64_t request);
  bool WellFormed(const BatchPart& part) const;
  // Whether the slot's pieces, all of which have arrived, cover the batch without holes or
  // overlaps.
  bool Tiled(const Slot& slot) const;

  const uint64_t spec_hash_, learner_session_, batch_bytes_;
  std::vector<Slot> slots_;
};

}  // namespace shoal::learner
