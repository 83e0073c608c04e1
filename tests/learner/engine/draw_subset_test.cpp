// SPDX-License-Identifier: Apache-2.0
#include "learner/engine/draw_subset.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace shoal::learner {
namespace {

using testing::ElementsAre;
using testing::UnorderedElementsAre;

TEST(DrawSubset, DrawsEachSubsetEquallyOften) {
  constexpr int kTrials = 20'000, kAll = 5, kDrawn = 2, kSubsets = 10;
  Random random(3);
  std::map<std::set<int32_t>, int> counts;
  for (int i = 0; i < kTrials; ++i) {
    const std::vector<int32_t> drawn = DrawSubset(kAll, kDrawn, &random);
    ASSERT_EQ(drawn.size(), size_t(kDrawn));
    ASSERT_TRUE(std::ranges::all_of(drawn, [](int32_t n) { return 0 <= n && n < kAll; }));
    ++counts[{drawn.begin(), drawn.end()}];
  }
  ASSERT_EQ(counts.size(), size_t(kSubsets)) << "a set of one number is a repetition";
  const double share = 1.0 / kSubsets;
  const double tolerance = 5 * std::sqrt(kTrials * share * (1 - share));
  for (const auto& [subset, count] : counts) EXPECT_NEAR(count, kTrials * share, tolerance);
}

TEST(DrawSubset, OfAllOrNoneHasNoChoice) {
  Random random(3);
  EXPECT_THAT(DrawSubset(3, 3, &random), UnorderedElementsAre(0, 1, 2));
  EXPECT_THAT(DrawSubset(1, 1, &random), ElementsAre(0));
  EXPECT_THAT(DrawSubset(4, 0, &random), ElementsAre());
}

TEST(DrawSubset, TakesOneNumberOfTheStreamForEachDraw) {
  Random random(3), same(3);
  DrawSubset(16, 5, &random);
  for (int i = 0; i < 5; ++i) same.Next();
  EXPECT_EQ(random.state(), same.state());
}

}  // namespace
}  // namespace shoal::learner
