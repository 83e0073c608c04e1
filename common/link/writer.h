// SPDX-License-Identifier: Apache-2.0
// A typed writer. M is a message of common/wire/messages.h; topic, plane and quality of service
// follow from M (message_list.h), its behaviour from the contract in hub.h.
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

  // Copies and sends the message. Blocks at most the topic's max_blocking; false when it was not
  // sent within it: keep it and try again. Any thread; one at a time per writer.
  bool Write(const M& message) {
    if constexpr (requires { message.payload; }) {
      CHECK(message.payload.size() <= kMaxPayloadBytes)
          << Topic<M>::kSettings.name << ": payload of " << message.payload.size() << " bytes";
    }
    return end_->Write(message);
  }
  // Matched readers now.
  int Matched() const { return end_->Matched(); }
  // Waits until every sample has arrived at all matched readers, for the exit of a process; the
  // callback of the last one may still run. False at the deadline; 0 asks without waiting.
  bool WaitForAcks(std::chrono::milliseconds deadline) { return end_->WaitForAcks(deadline); }

 private:
  std::unique_ptr<WriterEnd<M>> end_;
};

}  // namespace shoal::link
