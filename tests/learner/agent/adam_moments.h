// SPDX-License-Identifier: Apache-2.0
// Gradients g of one update, computed from Adam's first moment m, which was 0 before: m = (1 - 0.9)
// g.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/common/nn/gradient_check.h"
#include "tests/common/nn/reference_network.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {

constexpr double kFirstMoment = 0.1;  // m / g after the first update

// Compares Adam's moments in `after`, the tensors after an update, with central differences of
// `loss`, which reads `network`. Compares some entries of each parameter whose name starts with
// `prefix`.
inline void ExpectMoments(const nn::TensorMap& after, const std::string& prefix,
                          nn::reference::Network* network, const std::function<double()>& loss) {
  int compared = 0;
  for (const auto& [name, values] : network->parameters()) {
    if (!name.starts_with(prefix)) continue;
    const std::vector<float> moment = Floats(after, "adam.m." + name);
    std::vector<float> some;
    nn::reference::Values exact;
    for (size_t i = 0; i < values.size(); i += 1 + values.size() / 8) {
      some.push_back(moment[i]);
      exact.push_back(kFirstMoment * nn::CentralDifference(&network->at(name, i), loss));
    }
    EXPECT_LT(nn::RelativeError(some, exact), 1e-3) << name;
    ++compared;
  }
  EXPECT_GT(compared, 1) << prefix;
}

}  // namespace shoal::learner
