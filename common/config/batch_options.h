// SPDX-License-Identifier: Apache-2.0
// What learner and replay make of the configuration of a run to agree on its batches.
#pragma once

#include "common/config/run_config.h"
#include "common/wire/batch_schema.h"

namespace shoal {

// Throws Error as PrivilegedBlocksOf.
BatchOptions BatchOptionsOf(const RunConfig& run);
BatchSchema BatchSchemaOf(const RunConfig& run);

}  // namespace shoal
