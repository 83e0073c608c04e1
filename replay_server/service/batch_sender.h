// SPDX-License-Identifier: Apache-2.0
// Writes batches to the link on a separate thread, so that a slow network delays batches but not
// the storing of records.
//
// Owns a few batch buffers. The service thread fills a buffer and passes it to Send. The buffer is
// free again after all parts are written, or after the sender has dropped the batch. If a batch is
// in a slot of shared memory, only the slot message is sent; the caller owns the slot. A batch is
// dropped if its learner session is replaced, if no learner is connected, or if a part could not be
// written for kPartDeadline. The learner then sends its request again.
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

// Destination of the sender: the link, or a fake in tests.
class PartWriter {
 public:
  virtual ~PartWriter() = default;
  // Sends a message. Returns false if the message was not sent within the writer's own deadline.
  virtual bool Write(const BatchPart& part) = 0;
  virtual bool Write(const BatchSlot& slot) = 0;
  // Whether a reader of parts, or of slot messages, is connected.
  virtual bool HasPartReader() = 0;
  virtual bool HasSlotReader() = 0;
};

class BatchSender {
 public:
  static constexpr std::chrono::seconds kReaderDeadline{2};
  static constexpr std::chrono::seconds kPartDeadline{6};

  // Borrows the writer. `on_free` is called on the sender's thread each time a buffer becomes free.
  BatchSender(uint64_t spec_hash, uint64_t batch_bytes, int buffers, PartWriter* writer,
              std::function<void()> on_free);
  // Drops the batches that are not sent yet.
  ~BatchSender();
  BatchSender(const BatchSender&) = delete;
  BatchSender& operator=(const BatchSender&) = delete;

  // Returns a free buffer of batch_bytes bytes, aligned to 64, or nullptr if all buffers are in
  // use. The buffer stays free until Send().
  uint8_t* FreeBuffer();
  // Sends the batch in the buffer that FreeBuffer() returned.
  void Send(const DrawnBatch& batch, uint8_t* buffer);
  // Sends the message of a filled slot, unless the same message already waits to be sent.
  void Send(const BatchSlot& slot);
  // Sets the learner session. Batches of other sessions are dropped from now on.
  void SetLearnerSession(uint64_t session) { learner_session_ = session; }

  uint64_t sent() const { return sent_; }
  uint64_t given_up() const { return given_up_; }
  // Time spent on sending, including waits for the learner.
  double sending_seconds() const { return sending_seconds_; }

 private:
  // A batch in a buffer; a batch in a slot is a BatchSlot.
  struct BufferedBatch {
    DrawnBatch batch;
    uint8_t* buffer = nullptr;
  };
  using Outgoing = std::variant<BufferedBatch, BatchSlot>;

  void Run();
  // Waits for the next batch to send. Returns empty when the sender stops.
  std::optional<Outgoing> TakeNext();
  // Waits between two tries. Returns early when the sender stops.
  void Pause();
  bool SendBatch(const BufferedBatch& outgoing);
  bool SendBatch(const BatchSlot& slot);
  // `message`: a BatchPart or a BatchSlot.
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
  Thread thread_;  // last: starts after all other members are constructed
};

}  // namespace shoal::replay
