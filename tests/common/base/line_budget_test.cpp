// SPDX-License-Identifier: Apache-2.0
#include "common/base/line_budget.h"

#include <gtest/gtest.h>

namespace shoal {
namespace {

using std::chrono::seconds;

TEST(LineBudget, LeavesOutWhatIsMoreAndTellsHowMuchLater) {
  const SteadyTime start = Now();
  LineBudget budget;
  for (int i = 0; i < LineBudget::kLines; ++i) EXPECT_EQ(budget.Take(start), 0u) << i;
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(budget.Take(start + seconds(59))) << i;
  EXPECT_EQ(budget.Take(start + LineBudget::kSpan), 1000u);
  EXPECT_EQ(budget.Take(start + LineBudget::kSpan), 0u) << "told once";
}

TEST(LineBudget, AFewLinesNowAndThenAreAllTaken) {
  const SteadyTime start = Now();
  LineBudget budget;
  for (int minute = 0; minute < 10; ++minute) {
    for (int i = 0; i < LineBudget::kLines; ++i) {
      EXPECT_EQ(budget.Take(start + std::chrono::minutes(minute)), 0u);
    }
  }
}

}  // namespace
}  // namespace shoal
