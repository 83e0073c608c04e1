// SPDX-License-Identifier: Apache-2.0
#include "actor/hosted/action_mapping.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::hosted {

void MapAction(const tasks::ArraySpace& space, std::span<const float> policy_action,
               std::span<double> mapped) {
  CHECK(policy_action.size() == mapped.size()) << policy_action.size();
  CHECK(std::ssize(mapped) == space.size()) << mapped.size();
  for (size_t i = 0; i < mapped.size(); ++i) {
    const float a = policy_action[i];
    if (!std::isfinite(a)) {
      throw NonFiniteError("action component {} is {}: not finite; the policy's weights are bad", i,
                           a);
    }
    if (std::fabs(a) > 1) {
      throw RuntimeError("action component {} is {}; expected a number in [-1, 1]", i, a);
    }
    const double low = space.Low(int(i)), high = space.High(int(i));
    mapped[i] = std::clamp(low + (double{a} + 1) / 2 * (high - low), low, high);
  }
}

}  // namespace shoal::hosted
