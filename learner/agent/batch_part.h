// SPDX-License-Identifier: Apache-2.0
// The rows of a batch that one of several replicas learns from.
#pragma once

#include "common/wire/batch_schema.h"

namespace shoal::learner {

// Part `index` of `parts` equal ones in a row: its rows of every array, by member as by name.
// Borrows what `batch` borrows. CHECKs that the rows can be divided so.
BatchView PartOf(const BatchView& batch, int index, int parts);

}  // namespace shoal::learner
