// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/statistics_json.h"

#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

TEST(FormatMedian, SaysWhyThereIsNone) {
  EXPECT_EQ(FormatMedian(RatioOf({})), "no seed is done in both");
  EXPECT_EQ(FormatMedian(RatioOf({{0, 200, 100}})), "median 2.00 of 1 pair");
  EXPECT_EQ(FormatMedian(RatioOf({{0, 200, 100}, {1, 100, 100}, {2, std::nullopt, 100}})),
            "median 2.00 of 3 pairs, 1 not reached");
  EXPECT_EQ(FormatMedian(RatioOf({{0, std::nullopt, 100}, {1, 133, 100}})),
            "no median: 1 of 2 pairs did not reach the target");
}

TEST(FormatPairs, SaysWhichArmDidNotGetThere) {
  EXPECT_EQ(FormatPairs(RatioOf({{31, std::nullopt, 100}, {32, 133, 100}}), "b", "a"),
            "seed 31: not reached by b, seed 32: 1.33");
  EXPECT_EQ(
      FormatPairs(RatioOf({{1, 100, std::nullopt}, {2, std::nullopt, std::nullopt}}), "b", "a"),
      "seed 1: not reached by a, seed 2: not reached by either");
}

}  // namespace
}  // namespace shoal::launch
