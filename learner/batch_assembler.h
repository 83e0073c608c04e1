// SPDX-License-Identifier: Apache-2.0
// Assembles batches from their parts, in its own buffers. Uses no DDS, no threads and no clock.
//
// A request for a batch has an id. The answer is a set of parts that together contain the batch's
// bytes (common/wire/batch_schema.h). Parts may arrive in any order, between parts of other
// batches, and more than once. A request may be answered again, because the learner sent the
// request again or because the replay was restarted. The new answer may contain other transitions.
// Parts of two answers are never mixed: when the first part of the new answer arrives, all parts of
// the old answer are dropped. Two answers are distinguished by the replay's count of stored steps.
// If this count does not determine the samples, the caller calls StartOver when it repeats a
// request.
//
// At most `buffers` batches are assembled at the same time. A part of any other batch is dropped;
// the caller counts this part.
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
    kStartedOver,     // copied, as the first part of a new answer; the old answer was dropped
    kCompleted,       // copied; the batch is complete now
    kDuplicate,       // ignored: the part arrived before
    kUnknownRequest,  // ignored: the request was never expected or is already released
    kStaleSession,    // ignored: the part is for another learner session
    kWrongSpec,       // ignored: the part has another observation spec
    kMalformed,       // ignored: no batch of this layout has these sizes or offsets
  };

  struct Assembled {
    uint8_t* data;  // aligned to 64; valid until Release
    uint64_t stored_records, stored_steps, unsampleable_steps;
  };

  // Allocates memory for `buffers` batches of `batch_bytes`.
  BatchAssembler(uint64_t spec_hash, uint64_t learner_session, uint64_t batch_bytes, int buffers);

  // Reserves a free buffer for `request`, which must not have a buffer yet. Returns false if no
  // buffer is free.
  bool Expect(uint64_t request);
  Verdict Add(const BatchPart& part);
  // Drops the parts of a batch that is not complete.
  void StartOver(uint64_t request);
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
    std::vector<Piece> pieces;  // one for each part; empty until the first part arrives
    uint32_t missing = 0;       // number of missing parts, if `pieces` is not empty
  };

  Slot* Find(uint64_t request);
  bool WellFormed(const BatchPart& part) const;
  // Whether the slot's pieces cover the batch without gaps or overlaps. All pieces must have
  // arrived.
  bool Tiled(const Slot& slot) const;

  const uint64_t spec_hash_, learner_session_, batch_bytes_;
  std::vector<Slot> slots_;
};

}  // namespace shoal::learner
