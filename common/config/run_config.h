// SPDX-License-Identifier: Apache-2.0
// Description of a run: every key, and the spec of its observations. run_files.h writes and reads
// it.
#pragma once

#include "common/config/config.h"
#include "common/spec/observation_spec.h"

namespace shoal {

struct RunConfig {
  Config config;
  ObservationSpec spec;
};

}  // namespace shoal
