// SPDX-License-Identifier: Apache-2.0
#include "common/tensorboard/crc32c.h"

#include <gtest/gtest.h>

#include <string>

namespace shoal::tensorboard {
namespace {

// RFC 3720 appendix B.4 and the customary check value.
TEST(Crc32c, MatchesPublishedValues) {
  EXPECT_EQ(Crc32c("123456789"), 0xe3069283u);
  EXPECT_EQ(Crc32c(std::string(32, '\0')), 0x8a9136aau);
  EXPECT_EQ(Crc32c(std::string(32, '\xff')), 0x62a8ab43u);
  EXPECT_EQ(Crc32c(""), 0u);
}

TEST(Crc32c, MasksAsTfRecordDoes) { EXPECT_EQ(MaskCrc(0xe3069283u), 0xc78ab0e5u); }

}  // namespace
}  // namespace shoal::tensorboard
