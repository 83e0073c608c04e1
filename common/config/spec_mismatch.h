// SPDX-License-Identifier: Apache-2.0
// The reason why a run cannot be resumed: its actors would observe something else than the spec in
// its config.json.
#pragma once

#include <string>

#include "common/config/run_config.h"
#include "common/spec/observation_spec.h"

namespace shoal {

// One line for an error. If only the model's fingerprint differs, the line names the model file or
// task library that was changed since the run began; otherwise, the line describes both specs.
std::string SpecMismatch(const RunConfig& run, const ObservationSpec& now);

}  // namespace shoal
