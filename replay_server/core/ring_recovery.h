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

// Throws Error stating the difference unless the file is a complete ring of version kRingVersion
// for `spec`. Returns its capacity.
uint64_t CheckRingHeader(const Mapping& mapping, const ObservationSpec& spec,
                         const std::string& name);

struct RingExtent {
  uint64_t oldest_id = 1, last_id = 0;  // as Ring
  uint64_t stored_steps = 0;
};

// Finds the records. A writer that was killed leaves the newest records without holes and at most
// one slot half-written. Throws Error naming the slot if the file differs from this.
RingExtent ScanRing(const Mapping& mapping, const RingGeometry& geometry, const std::string& name,
                    const StartupProgress& progress = {});

// Finds the records while another process writes. Leaves out the eighth of a full ring that the
// writer overwrites next. Never throws.
RingExtent ScanLiveRing(const Mapping& mapping, const RingGeometry& geometry);

// Whether the commit word and the frame check of the slot match its content.
bool SlotIntact(const Mapping& mapping, const RingGeometry& geometry, uint64_t slot);

}  // namespace shoal::replay
