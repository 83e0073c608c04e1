// SPDX-License-Identifier: Apache-2.0
#include "common/base/nearest_name.h"

#include <gtest/gtest.h>

#include <vector>

namespace shoal {
namespace {

TEST(EditDistance, CountsInsertionsDeletionsAndReplacements) {
  EXPECT_EQ(EditDistance("", ""), 0);
  EXPECT_EQ(EditDistance("abc", ""), 3);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3);
  EXPECT_EQ(EditDistance("sitting", "kitten"), 3);
}

TEST(NearestHint, NamesTheNearestOfAMisspeltName) {
  const std::vector<std::string> names{"top", "train", "eval"};
  EXPECT_EQ(NearestHint("trian", names), "; nearest is 'train'");
  EXPECT_EQ(NearestHint("warp_drive", names), "");
  EXPECT_EQ(NearestHint("", names), "");
  EXPECT_EQ(NearestHint("train", {}), "");
}

}  // namespace
}  // namespace shoal
