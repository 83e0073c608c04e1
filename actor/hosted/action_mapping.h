// SPDX-License-Identifier: Apache-2.0
// A policy's action in the units of a user's environment:
//
//   mapped[i] = low[i] + (a[i] + 1) / 2 * (high[i] - low[i]), a in [-1, 1]
#pragma once

#include <span>

#include "common/tasks/environment_description.h"

namespace shoal::hosted {

// `policy_action` and `mapped` have one number for each element of `space`. Throws Error:
// kNonFinite if a number is not finite, kRuntime if a number is outside of [-1, 1].
void MapAction(const tasks::ArraySpace& space, std::span<const float> policy_action,
               std::span<double> mapped);

}  // namespace shoal::hosted
