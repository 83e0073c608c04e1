// SPDX-License-Identifier: Apache-2.0
#include "common/intake/receiver_terms.h"

#include <gtest/gtest.h>

namespace shoal {
namespace {

using std::chrono::milliseconds;

TEST(CreditSpacing, GrowsWithTheActorsSoThatTheWordsThatReachThemDoNot) {
  EXPECT_EQ(CreditSpacing(0), milliseconds(20));
  EXPECT_EQ(CreditSpacing(32), milliseconds(20));
  EXPECT_EQ(CreditSpacing(33), milliseconds(40));
  EXPECT_EQ(CreditSpacing(256), milliseconds(160));
}

TEST(CreditSpacing, StaysBelowTheRepetitionOfAllCredits) {
  EXPECT_EQ(CreditSpacing(10'000), milliseconds(500));
  EXPECT_LT(CreditSpacing(1'000'000), kCreditInterval);
}

}  // namespace
}  // namespace shoal
