// SPDX-License-Identifier: Apache-2.0
// A typed reader that calls back (hub.h has the contract).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "common/base/check.h"
#include "common/link/hub.h"
#include "common/link/topic.h"

namespace shoal::link {

template <class M>
class Reader {
 public:
  // `on_message` may run before the constructor returns. Borrows the hub. Throws Error.
  Reader(Hub& hub, std::function<void(const M&)> on_message) {
    CHECK(on_message != nullptr) << Topic<M>::kSettings.name;
    end_ = hub.MakeReader(MessageType<M>(), std::move(on_message));
  }
  // The default destructor waits for a running callback. A callback must not destroy its reader.

  // Number of writers that match now.
  int Matched() const { return end_->Matched(); }
  // Number of samples that could not be read.
  uint64_t Malformed() const { return end_->Malformed(); }

 private:
  std::unique_ptr<ReaderEnd> end_;
};

}  // namespace shoal::link
