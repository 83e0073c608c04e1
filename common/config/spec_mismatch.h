// SPDX-License-Identifier: Apache-2.0
// Error message for a run that cannot be resumed, because the observations of its actors would
// differ from the spec in its config.json.
#pragma once

#include <string>

#include "common/config/run_config.h"
#include "common/spec/observation_spec.h"

namespace shoal {

// One line for an error. If only the model's fingerprint differs, the line names the model file or
// task library that was changed since the run began. Otherwise, the line describes the two specs.
std::string SpecMismatch(const RunConfig& run, const ObservationSpec& now);

}  // namespace shoal
