// SPDX-License-Identifier: Apache-2.0
// Puts the parts of batches together in buffers of its own. Pure: no DDS, threads or clocks.
//
// A request for a batch has an id; the answer is a set of parts that tile its bytes
// (common/wire/batch_schema.h). Parts may arrive in any order, several batches at once, some twice.
// If a request is answered again (it was sent again, or the replay has restarted), the new answer
// may hold other transitions. Parts of two answers are never mixed: the newer answer starts over.
// The replay's count of steps at the draw distinguishes answers.
//
// Bound: `buffers` batches; a part that belongs to none of them is counted by the caller and
// dropped.
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
    kDuplicate,       // had been taken before
    kUnknownRequest,  // never expected, or done with
    kStaleSession,    // answers another learner session
    kWrongSpec,       // another observation spec
    kMalformed,       // sizes or offsets that no batch of this layout has
  };

  struct Assembled {
    uint8_t* data;  // aligned to 64; valid until Release
    uint64_t stored_records, stored_steps, unsampleable_steps;
  };

  // Batches of `batch_bytes` each; memory for `buffers` of them is taken at once.
  BatchAssembler(uint64_t spec_hash, uint64_t learner_session, uint64_t batch_bytes, int buffers);

  // Takes a free buffer for `request`, which must not be in use. False when there is none.
  bool Expect(uint64_t request);
  Verdict Add(const BatchPart& part);
  // The batch of `request` once it is whole.
  std::optional<Assembled> TryGet(uint64_t request);
  // Frees the buffer of `request`.
  void Release(uint64_t request);

 private:
  struct Piece {
    uint64_t offset = 0, bytes = 0;  // bytes 0: not here yet
  };
  struct Slot {
    uint64_t request = 0;  // 0: free
    AlignedBytes memory;
    bool whole = false;
    uint64_t stored_records = 0, stored_steps = 0;  // tell answers apart
    uint64_t unsampleable_steps = 0;
    std::vector<Piece> pieces;  // per part
    uint32_t missing = 0;       // parts; 0 and no pieces: none here yet
  };

  Slot* Find(uint64_t request);
  bool WellFormed(const BatchPart& part) const;
  // Whether the slot's pieces, all here, tile the batch without holes or overlaps.
  bool Tiled(const Slot& slot) const;

  const uint64_t spec_hash_, learner_session_, batch_bytes_;
  std::vector<Slot> slots_;
};

}  // namespace shoal::learner
