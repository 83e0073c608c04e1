// SPDX-License-Identifier: Apache-2.0
// Reads the records of an existing ring file.
#pragma once

#include <cstdint>
#include <string>

#include "common/spec/observation_spec.h"
#include "replay_server/core/mapping.h"
#include "replay_server/core/ring_format.h"
#include "replay_server/core/startup_progress.h"

namespace shoal::replay {

// Advice for a ring that cannot be used.
inline constexpr char kRingRemedy[] =
    "remove it, and the run goes on with an empty replay and its count of env steps";

// Returns the capacity of a ring. If the file is not a complete ring of version kRingVersion for
// `spec`, throws Error that contains the difference.
uint64_t CheckRingHeader(const Mapping& mapping, const ObservationSpec& spec,
                         const std::string& name);

struct RingExtent {
  uint64_t oldest_id = 1, last_id = 0;  // see Ring::oldest_id
  uint64_t stored_steps = 0;
};

// Finds the records of a ring. If the writer was killed, the file must contain the newest records
// without gaps, and at most one incomplete slot. Otherwise, throws Error that names the slot.
RingExtent ScanRing(const Mapping& mapping, const RingGeometry& geometry, const std::string& name,
                    const StartupProgress& progress = {});

// Finds the records while another process writes. If the ring is full, leaves out the oldest eighth
// of the records, which the writer overwrites next. Never throws.
RingExtent ScanLiveRing(const Mapping& mapping, const RingGeometry& geometry);

// Whether the commit word and the frame check of the slot match its content.
bool SlotIntact(const Mapping& mapping, const RingGeometry& geometry, uint64_t slot);

}  // namespace shoal::replay
