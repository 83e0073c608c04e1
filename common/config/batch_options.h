// SPDX-License-Identifier: Apache-2.0
// Options of batches. The learner and the replay each derive these options from the configuration
// of the run, so that they use the same format.
#pragma once

#include "common/config/run_config.h"
#include "common/wire/batch_schema.h"

namespace shoal {

// The two functions throw the same errors as PrivilegedBlocksOf.
BatchOptions BatchOptionsOf(const RunConfig& run);
BatchSchema BatchSchemaOf(const RunConfig& run);

}  // namespace shoal
