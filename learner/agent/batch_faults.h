// What makes a batch unfit for an update.
#pragma once

#include "common/wire/batch_layout.h"

namespace shoal::learner {

// True if every float of the batch (vectors, actions, rewards, bootstraps) is finite.
bool AllFinite(const BatchView& batch);

}  // namespace shoal::learner
