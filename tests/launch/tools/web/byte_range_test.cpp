// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/byte_range.h"

#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

void ExpectPart(const char* header, uint64_t offset, uint64_t bytes) {
  ByteRange range;
  EXPECT_EQ(ParseByteRange(header, 1000, &range), RangeAsked::kPart) << header;
  EXPECT_EQ(range.offset, offset) << header;
  EXPECT_EQ(range.bytes, bytes) << header;
}

TEST(ByteRange, PartsLieWithinTheFile) {
  ExpectPart("bytes=0-0", 0, 1);
  ExpectPart("bytes=0-", 0, 1000);
  ExpectPart("bytes=200-299", 200, 100);
  ExpectPart("bytes=990-5000", 990, 10);
  ExpectPart("bytes=999-18446744073709551615", 999, 1);
  ExpectPart("bytes=-10", 990, 10);
  ExpectPart("bytes=-5000", 0, 1000);
}

TEST(ByteRange, WhatBeginsBehindTheEndIsOutside) {
  ByteRange range;
  EXPECT_EQ(ParseByteRange("bytes=1000-", 1000, &range), RangeAsked::kOutside);
  EXPECT_EQ(ParseByteRange("bytes=-0", 1000, &range), RangeAsked::kOutside);
  EXPECT_EQ(ParseByteRange("bytes=0-", 0, &range), RangeAsked::kOutside);
  EXPECT_EQ(ParseByteRange("bytes=-1", 0, &range), RangeAsked::kOutside);
}

TEST(ByteRange, WhatIsNotOneRangeIsTheWholeFile) {
  ByteRange range;
  for (const char* header :
       {"", "bytes=", "bytes=-", "bytes=a-b", "bytes=1", "items=0-1", "bytes=0-1,3-4", "bytes=5-4",
        "bytes=0--1", "bytes= 0-1", "bytes=99999999999999999999-", "bytes=+1-2"}) {
    EXPECT_EQ(ParseByteRange(header, 1000, &range), RangeAsked::kWhole) << header;
  }
}

}  // namespace
}  // namespace shoal::launch
