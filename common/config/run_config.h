// SPDX-License-Identifier: Apache-2.0
// What a run is: every key, and what is observed in it. Knows no file: run_files.h writes and reads
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
