// SPDX-License-Identifier: Apache-2.0
// A hub that consists of two hubs. The coordinator of a run in one process connects to the roles in
// memory and to its clients on the network.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "common/link/hub.h"
#include "common/link/topic.h"

namespace shoal::link {

class PlaneHub final : public Hub {
 public:
  // `operate` carries Plane::kOperate; `rest` carries the other planes. Borrows the two hubs.
  PlaneHub(Hub& rest, Hub& operate) : rest_(rest), operate_(operate) {}

  std::map<std::string, uint64_t> Malformed() const override {
    std::map<std::string, uint64_t> all = rest_.Malformed();
    all.merge(operate_.Malformed());
    return all;
  }

#define SHOAL_PLANE_HUB_ENDS(message, ...)                                                       \
  std::unique_ptr<WriterEnd<message>> MakeWriter(MessageType<message> type) override {           \
    return HubOf<message>().MakeWriter(type);                                                    \
  }                                                                                              \
  std::unique_ptr<ReaderEnd> MakeReader(MessageType<message> type,                               \
                                        std::function<void(const message&)> callback) override { \
    return HubOf<message>().MakeReader(type, std::move(callback));                               \
  }
  SHOAL_MESSAGES(SHOAL_PLANE_HUB_ENDS)
#undef SHOAL_PLANE_HUB_ENDS

 private:
  template <class M>
  Hub& HubOf() {
    return Topic<M>::kSettings.plane == Plane::kOperate ? operate_ : rest_;
  }

  Hub& rest_;
  Hub& operate_;
};

}  // namespace shoal::link
