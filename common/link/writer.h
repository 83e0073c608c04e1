// SPDX-License-Identifier: Apache-2.0
// A typed writer. M is a message of common/wire/messages.h. message_list.h defines the topic, the
// plane and the quality of service of M; the contract in hub.h defines the writer's behaviour.
#pragma once

#include <chrono>
#include <memory>

#include "common/base/check.h"
#include "common/link/hub.h"
#include "common/link/topic.h"

namespace shoal::link {

template <class M>
class Writer {
 public:
  // Borrows the hub. Throws Error.
  explicit Writer(Hub& hub) : end_(hub.MakeWriter(MessageType<M>())) {}

  // Copies and sends the message. Blocks for at most the topic's max_blocking. Returns false if the
  // message could not be sent in this time; the caller then keeps the message and tries again. Any
  // thread may call it, but only one thread at a time for each writer.
  bool Write(const M& message) {
    if constexpr (requires { message.payload; }) {
      CHECK(message.payload.size() <= kMaxPayloadBytes)
          << Topic<M>::kSettings.name << ": payload of " << message.payload.size() << " bytes";
    }
    return end_->Write(message);
  }
  // Number of readers that match now.
  int Matched() const { return end_->Matched(); }
  // Waits until every sample has arrived at all matched readers. A process calls this function
  // before it exits. The callback of the last sample may still run. Returns false at the deadline.
  // A deadline of 0 checks without waiting.
  bool WaitForAcks(std::chrono::milliseconds deadline) { return end_->WaitForAcks(deadline); }

 private:
  std::unique_ptr<WriterEnd<M>> end_;
};

}  // namespace shoal::link
