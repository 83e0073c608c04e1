// What learner and replay make of the configuration of a run to agree on its batches.
#pragma once

#include "common/config/run_files.h"
#include "common/wire/batch_schema.h"

namespace shoal {

BatchOptions BatchOptionsOf(const Config& config);
BatchSchema BatchSchemaOf(const RunConfig& run);

}  // namespace shoal
