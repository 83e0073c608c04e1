// SPDX-License-Identifier: Apache-2.0
// The members of a Bus. Internal to common/dds.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <string>

#include "common/base/error.h"
#include "common/base/mutex.h"
#include "common/dds/bus.h"
#include "common/dds/entity.h"

namespace shoal::dds {

// Thrown if another process has a fixed port of the role. ClaimDomain then tries the next domain.
class PortTakenError : public Error {
 public:
  explicit PortTakenError(const Error& error) : Error(error) {}
};

// Members are destroyed in reverse order, so that a participant is deleted before its domain.
struct Bus::Impl {
  Entity main_domain, main_participant;        // all roles except clients
  Entity batch_domain, batch_participant;      // learner and replay
  Entity operate_domain, operate_participant;  // coordinator and clients

  // The counter of a topic's malformed messages, shared by the bus and the topic's readers.
  std::shared_ptr<std::atomic<uint64_t>> MalformedCounter(const std::string& topic) {
    const MutexLock lock(mutex);
    auto& counter = malformed[topic];
    if (!counter) counter = std::make_shared<std::atomic<uint64_t>>(0);
    return counter;
  }

  mutable Mutex mutex;
  std::map<std::string, std::shared_ptr<std::atomic<uint64_t>>> malformed SHOAL_GUARDED_BY(mutex);

  dds_entity_t Participant(Plane plane) const {
    switch (plane) {
      case Plane::kMain:
        return main_participant.get();
      case Plane::kBatch:
        return batch_participant.get();
      case Plane::kOperate:
        break;
    }
    return operate_participant.get();
  }
};

}  // namespace shoal::dds
