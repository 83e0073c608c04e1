// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/config/config.h"

namespace shoal::learner {

// Numbers that a critic computes for an action: a value, or its quantiles (Eq. 35).
inline int CriticOutputs(const Config& config) { return std::max(1, config.sac.quantiles); }

}  // namespace shoal::learner
