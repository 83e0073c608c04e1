// SPDX-License-Identifier: Apache-2.0
#include "common/base/crc32.h"

#include <gtest/gtest.h>

#include <string_view>

namespace shoal {
namespace {

TEST(Crc32, MatchesThePublishedCheckValue) {
  const std::string_view text = "123456789";
  EXPECT_EQ(Crc32({reinterpret_cast<const uint8_t*>(text.data()), text.size()}), 0xcbf43926u);
}

}  // namespace
}  // namespace shoal
