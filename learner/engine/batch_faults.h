// SPDX-License-Identifier: Apache-2.0
// Checks for numbers with which an update must not be applied.
#pragma once

#include "common/wire/batch_schema.h"

namespace shoal::learner {

// True if every float of the batch that a network or a loss reads is finite: vectors, actions,
// rewards, bootstraps, and log-probabilities of a rollout.
bool AllFinite(const BatchView& batch);

// False if the sum of the gradients' squares would overflow in Adam's second moment.
bool FitsMoments(double gradient_squares);

}  // namespace shoal::learner
