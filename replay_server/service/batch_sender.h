// SPDX-License-Identifier: Apache-2.0
// The bulk writes of batches, on a thread of their own: a slow network holds up batches, not
// intake.
//
// Owns a few batch buffers. The service thread fills one and hands it over; it comes back when all
// its parts are written or given up. For a batch in a slot of shared memory only the slot message
// is sent; the caller owns the slot. A batch is given up when its learner session is replaced, when
// no learner is connected, or when a part could not be written for kPartDeadline: the learner sends
// its request again.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/base/aligned_bytes.h"
#include "common/base/mutex.h"
#include "common/base/thread_group.h"
#include "common/wire/messages.h"
#include "replay_server/core/replay_core.h"

namespace shoal::replay {

// Destination of the sender: the link, or a fake.
class PartWriter {
 public:
  virtual ~PartWriter() = default;
  // False when it was not sent within the writer's own deadline.
  virtual bool Write(const BatchPart& part) = 0;
  virtual bool Write(const BatchSlot& slot) = 0;
  // A learner is there to read them.
  virtual bool HasPartReader() = 0;
  virtual bool HasSlotReader() = 0;
};

class BatchSender {
 public:
  static constexpr std::chrono::seconds kReaderDeadline{2};
  static constexpr std::chrono::seconds kPartDeadline{6};

  // Borrows the writer. `on_free` is called on the sender's thread whenever a buffer is free again.
  BatchSender(uint64_t spec_hash, uint64_t batch_bytes, int buffers, PartWriter* writer,
              std::function<void()> on_free);
  // Gives up what is not sent.
  ~BatchSender();
  BatchSender(const BatchSender&) = delete;
  BatchSender& operator=(const BatchSender&) = delete;

  // A free buffer of batch_bytes, aligned to 64, or nullptr while all are on their way. It stays
  // free until Send().
  uint8_t* FreeBuffer();
  // Sends the batch in the buffer that FreeBuffer() returned.
  void Send(const DrawnBatch& batch, uint8_t* buffer);
  // Sends the message of a filled slot, unless the same message already waits to be sent.
  void Send(const BatchSlot& slot);
  // Batches of other sessions are given up.
  void SetLearnerSession(uint64_t session) { learner_session_ = session; }

  uint64_t sent() const { return sent_; }
  uint64_t given_up() const { return given_up_; }
  // Time spent on sending, including waits for the learner.
  double sending_seconds() const { return sending_seconds_; }

 private:
  // Either of them.
  struct BufferedBatch {
    DrawnBatch batch;
    uint8_t* buffer = nullptr;
  };
  using Outgoing = std::variant<BufferedBatch, BatchSlot>;

  void Run();
  // The next batch to send; waits for it. Nothing when stopping.
  std::optional<Outgoing> TakeNext();
  // Between tries; ends early when stopping.
  void Pause();
  bool SendBatch(const BufferedBatch& outgoing);
  bool SendBatch(const BatchSlot& slot);
  // A BatchPart or a BatchSlot.
  bool SendMessage(const auto& message, const std::string& what);
  bool WaitForReader(uint64_t session, bool (PartWriter::*has_reader)());
  bool Wanted(uint64_t session) const { return !stopping_ && session == learner_session_; }

  const uint64_t spec_hash_, batch_bytes_;
  PartWriter& writer_;
  const std::function<void()> on_free_;
  std::vector<AlignedBytes> memory_;
  Mutex mutex_;
  ConditionVariable changed_;
  std::vector<uint8_t*> free_ SHOAL_GUARDED_BY(mutex_);
  std::deque<Outgoing> queue_ SHOAL_GUARDED_BY(mutex_);
  std::atomic<bool> stopping_{false};
  std::atomic<uint64_t> learner_session_{0};
  std::atomic<uint64_t> sent_{0}, given_up_{0};
  std::atomic<double> sending_seconds_{0};
  Thread thread_;  // last: starts when everything else is there
};

}  // namespace shoal::replay
