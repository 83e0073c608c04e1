// SPDX-License-Identifier: Apache-2.0
// Options of batches that learner and replay both derive from the configuration of a run. Equal
// options on both sides make their batches agree.
#pragma once

#include "common/config/run_config.h"
#include "common/wire/batch_schema.h"

namespace shoal {

// Throws Error as PrivilegedBlocksOf does.
BatchOptions BatchOptionsOf(const RunConfig& run);
BatchSchema BatchSchemaOf(const RunConfig& run);

}  // namespace shoal
