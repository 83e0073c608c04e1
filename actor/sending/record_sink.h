// SPDX-License-Identifier: Apache-2.0
// Sink of a rollout's records. Provides memory for one record after another, for as many records as
// the receiver allows.
#pragma once

#include <cstddef>
#include <cstdint>

namespace shoal::actor {

class RecordSink {
 public:
  virtual ~RecordSink() = default;
  // Number of records that can be begun now, limited by memory and by the receiver's credit.
  virtual size_t Room() const = 0;
  // Memory for the next record, zeroed, aligned to 8, valid until EndRecord. Room() must not be 0.
  virtual uint8_t* BeginRecord() = 0;
  // Completes the record begun last. `sequence` must be the previous sequence plus 1.
  virtual void EndRecord(uint64_t sequence) = 0;
};

}  // namespace shoal::actor
