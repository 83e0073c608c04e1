// SPDX-License-Identifier: Apache-2.0
// Description of a run: every key, and the spec of its observations. run_files.h has the functions
// that write and read the description.
#pragma once

#include "common/config/config.h"
#include "common/spec/observation_spec.h"

namespace shoal {

struct RunConfig {
  Config config;
  ObservationSpec spec;
};

}  // namespace shoal
