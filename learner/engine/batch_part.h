// SPDX-License-Identifier: Apache-2.0
// The rows of a batch from which one of several replicas learns.
#pragma once

#include "common/nn/replica.h"
#include "common/wire/batch_schema.h"

namespace shoal::learner {

// Returns rows `rows` of every array, both as members and by name. Borrows the memory that `batch`
// borrows. CHECKs that the batch has these rows.
BatchView PartOf(const BatchView& batch, const nn::Replica::Rows& rows);

}  // namespace shoal::learner
