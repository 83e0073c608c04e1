// SPDX-License-Identifier: Apache-2.0
// The rows of a batch that one of several replicas learns from.
#pragma once

#include "common/nn/replica.h"
#include "common/wire/batch_schema.h"

namespace shoal::learner {

// Rows `rows` of every array, by member as by name. Borrows what `batch` borrows. CHECKs that the
// batch has them.
BatchView PartOf(const BatchView& batch, const nn::Replica::Rows& rows);

}  // namespace shoal::learner
