// SPDX-License-Identifier: Apache-2.0
// When an update must not be applied.
#pragma once

#include "common/wire/batch_schema.h"

namespace shoal::learner {

// True if every float of the batch (vectors, actions, rewards, bootstraps) is finite.
bool AllFinite(const BatchView& batch);

// False where the loss is not finite, or the sum of its gradients' squares would overflow in Adam's
// second moment.
bool Usable(float loss, double gradient_squares);

}  // namespace shoal::learner
