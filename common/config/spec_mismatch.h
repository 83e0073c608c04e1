// SPDX-License-Identifier: Apache-2.0
// The reason why a run cannot be resumed: its actors would observe something else than its
// config.json says.
#pragma once

#include <string>

#include "common/config/run_config.h"
#include "common/spec/observation_spec.h"

namespace shoal {

// One line for an error. Where only the model's fingerprint differs it names the model file, or the
// task library, that was changed since the run began; else both observations.
std::string SpecMismatch(const RunConfig& run, const ObservationSpec& now);

}  // namespace shoal
