// SPDX-License-Identifier: Apache-2.0
#include "launch/record/first_reached.h"

#include <gtest/gtest.h>

#include <vector>

namespace shoal::launch {
namespace {

std::vector<EvaluatedSuccess> Evaluations(const std::vector<double>& rates) {
  std::vector<EvaluatedSuccess> evaluations;
  for (const double rate : rates) evaluations.push_back({rate, 100});
  return evaluations;
}

TEST(FirstReached, IsTheFirstOfThoseThatReachItTogether) {
  const auto curve = Evaluations({0.5, 0.9, 0.8, 0.95, 0.86, 0.1});
  EXPECT_EQ(FirstReached(curve, 0.9, 2), 3u) << "181 of 200, though one of the two is below";
  EXPECT_EQ(FirstReached(curve, 0.85, 2), 1u) << "170 of 200";
  EXPECT_EQ(FirstReached(curve, 0.95, 2), std::nullopt) << "once is not twice";
  EXPECT_EQ(FirstReached(curve, 0.95, 1), 3u);
  EXPECT_EQ(FirstReached({}, 0.5, 2), std::nullopt);
  EXPECT_EQ(FirstReached(Evaluations({1}), 0.5, 2), std::nullopt);
}

TEST(FirstReached, WeighsEvaluationsByTheirEpisodes) {
  const std::vector<EvaluatedSuccess> uneven{{1.0, 10}, {0.88, 100}};
  EXPECT_FALSE(ReachTogether(uneven, 0.9)) << "98 of 110";
  EXPECT_TRUE(ReachTogether(uneven, 0.89));
}

TEST(FirstReached, ATaskWithoutSuccessReachesNothing) {
  const std::vector<EvaluatedSuccess> without{{std::nullopt, 100}, {1.0, 100}};
  EXPECT_FALSE(ReachTogether(without, 0));
  EXPECT_FALSE(ReachTogether({}, 0));
}

// 0.29 * 100 is 28.999999999999996.
TEST(FirstReached, RoundingMissesNoTarget) {
  EXPECT_TRUE(ReachTogether(Evaluations({0.29, 0.29}), 0.29));
}

}  // namespace
}  // namespace shoal::launch
