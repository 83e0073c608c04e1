// What a Bus owns. Internal to common/dds.
#pragma once

#include "common/base/error.h"
#include "common/dds/bus.h"
#include "common/dds/entity.h"

namespace shoal::dds {

// A fixed port of the role is held by another process: ClaimDomain goes on to the next domain.
class PortTakenError : public Error {
 public:
  explicit PortTakenError(const Error& error) : Error(error) {}
};

// Members are deleted in reverse order: participants before their domain.
struct Bus::Impl {
  Entity main_domain, main_participant;
  Entity batch_domain, batch_participant;  // empty for coordinator and actors

  dds_entity_t Participant(Plane plane) const {
    return (plane == Plane::kMain ? main_participant : batch_participant).get();
  }
};

}  // namespace shoal::dds
