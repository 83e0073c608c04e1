// SPDX-License-Identifier: Apache-2.0
// Typed readers that call back from a DDS receive thread.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "common/dds/bus.h"
#include "common/dds/message_list.h"
#include "common/wire/messages.h"

namespace shoal::dds {

template <class M>
class Subscriber {
 public:
  // `on_message` runs on a receive thread of the bus (or on the writing thread when the writer is
  // in this process), one call at a time, and may run before the constructor returns. It must not
  // block, throw or create entities; it copies what it keeps. Malformed samples are counted, said
  // in the log once per interval and not delivered. Borrows the bus. Throws Error when DDS refuses.
  Subscriber(Bus& bus, std::function<void(const M&)> on_message);
  // After return no callback runs. Not to be called from the callback.
  ~Subscriber();
  Subscriber(const Subscriber&) = delete;
  Subscriber& operator=(const Subscriber&) = delete;

  // Matched writers now.
  int Matched() const;
  uint64_t Malformed() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

#define SHOAL_EXTERN(message, ...) extern template class Subscriber<message>;
SHOAL_MESSAGES(SHOAL_EXTERN)
#undef SHOAL_EXTERN

}  // namespace shoal::dds
