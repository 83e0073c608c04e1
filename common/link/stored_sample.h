// SPDX-License-Identifier: Apache-2.0
// A message in the memory of the link within one process. The message is copied once, when it is
// written. All readers share this copy, which never changes.
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>

#include "common/base/aligned_bytes.h"
#include "common/base/mutex.h"
#include "common/link/topic.h"

namespace shoal::link {

// Number and bytes of one writer's samples that at least one reader has not finished reading. The
// writer's samples share this object, so the object may outlive the writer. The exchange's mutex
// guards the counts (local_exchange.h).
struct Unread {
  uint64_t samples = 0;
  uint64_t bytes = 0;
  ConditionVariable fell;  // notified when the counts decrease
};

class StoredSample {
 public:
  virtual ~StoredSample() = default;
  StoredSample(const StoredSample&) = delete;
  StoredSample& operator=(const StoredSample&) = delete;

  const Key& key() const { return key_; }
  // Bytes that count against the writer's bound.
  uint64_t bytes() const { return bytes_; }
  // All samples of a writer share one Unread. Samples of different writers have different ones.
  Unread& unread() const { return *unread_; }

  // Number of readers that have not finished reading the sample. The exchange's mutex guards this
  // number.
  int unread_by = 0;

 protected:
  StoredSample(std::shared_ptr<Unread> unread, Key key, uint64_t bytes)
      : unread_(std::move(unread)), key_(std::move(key)), bytes_(bytes) {}

 private:
  const std::shared_ptr<Unread> unread_;
  const Key key_;
  const uint64_t bytes_;
};

using SharedSample = std::shared_ptr<StoredSample>;

template <class M>
class StoredMessage final : public StoredSample {
 public:
  // Copies the message and its payload. Throws Error if there is no memory for the payload.
  StoredMessage(std::shared_ptr<Unread> unread, const M& message)
      : StoredSample(std::move(unread), KeyOf(message), Bytes(message)), message_(message) {
    if constexpr (requires { message_.payload; }) {
      payload_ = AlignedBytes(message.payload.size());
      // An empty span may have no address, which memcpy does not allow.
      if (!message.payload.empty()) {
        std::memcpy(payload_.data(), message.payload.data(), message.payload.size());
      }
      message_.payload = {payload_.data(), message.payload.size()};
    }
  }

  const M& message() const { return message_; }

  // The bytes that a stored copy of `message` counts against the writer's bound.
  static uint64_t Bytes(const M& message) {
    uint64_t bytes = sizeof(M);
    if constexpr (requires { message.payload; }) bytes += message.payload.size();
    return bytes;
  }

 private:
  AlignedBytes payload_;  // empty if M has no payload
  M message_;             // its payload is payload_
};

}  // namespace shoal::link
