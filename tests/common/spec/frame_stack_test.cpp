// SPDX-License-Identifier: Apache-2.0
#include "common/spec/frame_stack.h"

#include <gtest/gtest.h>

#include <span>
#include <vector>

namespace shoal {
namespace {

using Bytes = std::vector<uint8_t>;

TEST(FrameStack, RepeatsTheFirstFrameThenKeepsTheLastOldestFirst) {
  Bytes memory(6);
  FrameStack stack(memory, 2);
  stack.Reset(Bytes{1, 2});
  EXPECT_EQ(memory, (Bytes{1, 2, 1, 2, 1, 2}));
  stack.Push(Bytes{3, 4});
  stack.Push(Bytes{5, 6});
  EXPECT_EQ(memory, (Bytes{1, 2, 3, 4, 5, 6}));
  stack.Push(Bytes{7, 8});
  EXPECT_EQ(memory, (Bytes{3, 4, 5, 6, 7, 8}));
  stack.Reset(Bytes{9, 9});
  EXPECT_EQ(memory, (Bytes{9, 9, 9, 9, 9, 9}));
}

// A batch without pixels has slices without bytes.
TEST(FrameStack, OfNoFramesLeavesItsNeighboursAlone) {
  Bytes memory{1, 2, 3, 4};
  FrameStack stack(std::span<uint8_t>(memory).subspan(2, 0), 1);
  stack.Reset(Bytes{9});
  stack.Push(Bytes{9});
  EXPECT_EQ(memory, (Bytes{1, 2, 3, 4}));
}

}  // namespace
}  // namespace shoal
