// SPDX-License-Identifier: Apache-2.0
#include "common/config/nearest_key.h"

#include <gtest/gtest.h>

namespace shoal::internal {
namespace {

TEST(NearestKey, FindsMisspelledPaths) {
  EXPECT_EQ(NearestKey("learner.bach"), "learner.batch");
  EXPECT_EQ(NearestKey("sed"), "seed");
}

TEST(NearestKey, FindsTheSectionOfABareName) {
  EXPECT_EQ(NearestKey("samples_per_insert"), "replay.samples_per_insert");
  EXPECT_EQ(NearestKey("chunk_record"), "transport.chunk_records");
}

TEST(NearestKey, AnotherWordHasNone) {
  EXPECT_EQ(NearestKey("warp_drive"), "");
  EXPECT_EQ(NearestKey("q"), "");
  EXPECT_EQ(NearestKey(""), "");
}

}  // namespace
}  // namespace shoal::internal
