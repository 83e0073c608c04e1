// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/critic_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace shoal::learner {
namespace {

using testing::ElementsAre;
using testing::FloatNear;

// Schaul et al. 2016, section 3.4: w_i = (N P_i)^-b / max_j w_j.
TEST(ImportanceWeights, AreThePublishedOnesForAnyNumberOfSamples) {
  const std::vector<float> probabilities{0.02f, 0.001f, 0.5f, 0.001f, 0.3f};
  for (const double b : {0.0, 0.4, 0.75, 1.0}) {
    for (const double n : {10.0, 1e6}) {
      std::vector<double> expected;
      double largest = 0;
      for (const float p : probabilities) {
        expected.push_back(std::pow(n * p, -b));
        largest = std::max(largest, expected.back());
      }
      const std::vector<float> weights = ImportanceWeights(probabilities, b);
      ASSERT_EQ(weights.size(), probabilities.size());
      for (size_t i = 0; i < weights.size(); ++i) {
        EXPECT_NEAR(weights[i], expected[i] / largest, 1e-6) << i << " " << b;
      }
    }
  }
}

TEST(ImportanceWeights, OfEqualProbabilitiesAreOne) {
  EXPECT_THAT(ImportanceWeights(std::vector<float>(3, 1e-5f), 0.7), ElementsAre(1, 1, 1));
  EXPECT_THAT(ImportanceWeights(std::vector<float>{0.1f, 0.4f}, 0.5),
              ElementsAre(1, FloatNear(0.5f, 1e-6f)));
}

}  // namespace
}  // namespace shoal::learner
