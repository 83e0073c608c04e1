// The rows of a batch that one of several replicas learns from.
#pragma once

#include "common/wire/batch_schema.h"

namespace shoal::learner {

// Part `index` of `parts` equal ones in a row. Arrays are reached by member alone: by name they are
// the whole batch's, so the part has no schema. Borrows what `batch` borrows. CHECKs that the rows
// can be divided so.
BatchView PartOf(const BatchView& batch, int index, int parts);

}  // namespace shoal::learner
