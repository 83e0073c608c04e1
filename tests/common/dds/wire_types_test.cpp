// SPDX-License-Identifier: Apache-2.0
#include "common/dds/wire_types.h"

#include <gtest/gtest.h>

#include <vector>

namespace shoal::dds {
namespace {

TEST(WireTypes, PayloadsAreBorrowedNotCopied) {
  const std::vector<uint8_t> payload{1, 2, 3};
  TransitionChunk chunk;
  chunk.payload = payload;
  WireBuffers buffers;
  EXPECT_EQ(ToWire(chunk, &buffers).payload._buffer, payload.data());
  EXPECT_FALSE(ToWire(chunk, &buffers).payload._release);
}

}  // namespace
}  // namespace shoal::dds
