// SPDX-License-Identifier: Apache-2.0
#include "common/base/saturating_cast.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace shoal {
namespace {

TEST(SaturatingCast, KeepsWhatFits) {
  EXPECT_EQ(SaturatingCast<int>(-2.9), -2);
  EXPECT_EQ(SaturatingCast<int>(2147483647.0), 2147483647);
  EXPECT_EQ(SaturatingCast<uint64_t>(9007199254740993.0), 9007199254740992u);
}

TEST(SaturatingCast, EndsAtTheLimits) {
  EXPECT_EQ(SaturatingCast<int>(1e48), std::numeric_limits<int>::max());
  EXPECT_EQ(SaturatingCast<int>(-1e48), std::numeric_limits<int>::min());
  EXPECT_EQ(SaturatingCast<int64_t>(9223372036854775808.0), std::numeric_limits<int64_t>::max());
  EXPECT_EQ(SaturatingCast<uint64_t>(std::numeric_limits<double>::infinity()),
            std::numeric_limits<uint64_t>::max());
  EXPECT_EQ(SaturatingCast<uint64_t>(-1.0), 0u);
}

TEST(SaturatingCast, MakesNoNumberZero) {
  EXPECT_EQ(SaturatingCast<int64_t>(std::numeric_limits<double>::quiet_NaN()), 0);
}

}  // namespace
}  // namespace shoal
