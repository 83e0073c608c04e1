// SPDX-License-Identifier: Apache-2.0
// Typed writers. M is a message of common/wire/messages.h; topic, domain and QoS follow from M
// (docs/wire_format.md).
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>

#include "common/dds/bus.h"
#include "common/dds/message_list.h"
#include "common/wire/messages.h"

namespace shoal::dds {

// Upper bound of a payload in bytes; receivers drop larger samples. Speed wants chunks and parts
// of at most 1 MB.
inline constexpr uint64_t kMaxPayloadBytes = 63'000'000;

template <class M>
class Publisher {
 public:
  // Borrows the bus. Throws Error when DDS refuses.
  explicit Publisher(Bus& bus);
  // Withdraws the writer: late joiners get nothing more, unacknowledged samples are lost.
  ~Publisher();
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  // Copies and sends the message. Blocks at most the topic's max_blocking_time (docs); false when
  // it was not sent within it: keep it and try again. Any thread; one at a time per publisher. A
  // reader in this process gets it before the call returns, on this thread.
  bool Write(const M& message);
  // Matched readers now.
  int Matched() const;
  // Waits until all matched readers have acknowledged, for the exit of a process.
  bool WaitForAcks(std::chrono::milliseconds deadline);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

#define SHOAL_EXTERN(message, ...) extern template class Publisher<message>;
SHOAL_MESSAGES(SHOAL_EXTERN)
#undef SHOAL_EXTERN

}  // namespace shoal::dds
