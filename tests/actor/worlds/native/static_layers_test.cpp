// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/static_layers.h"

#include <gtest/gtest.h>

namespace shoal::worlds::native {
namespace {

class StaticLayersTest : public testing::Test {
 protected:
  StaticLayersTest() {
    view_.width = view_.height = view_.tiles_x = view_.tiles_y = 64;
    picture_.Resize(view_);
  }

  View view_{};
  TileBuffer picture_;
  StaticLayers layers_;
};

TEST_F(StaticLayersTest, OnlyASecondMissIsWorthALayer) {
  EXPECT_FALSE(layers_.Miss({1, 2}));
  EXPECT_FALSE(layers_.Miss({1, 3}));
  EXPECT_TRUE(layers_.Miss({1, 2}));
}

// A camera that moves a little in each frame makes no layers: keys differ in any one word.
TEST_F(StaticLayersTest, KeysThatDifferInOneWordAreNotMistaken) {
  const StaticLayers::Key key(11, 7);
  EXPECT_FALSE(layers_.Miss(key));
  for (size_t word = 0; word < key.size(); ++word) {
    for (const uint32_t bit : {0u, 15u, 31u}) {
      StaticLayers::Key other = key;
      other[word] ^= 1u << bit;
      EXPECT_FALSE(layers_.Miss(other)) << "word " << word << ", bit " << bit;
    }
  }
  EXPECT_FALSE(layers_.Miss(StaticLayers::Key(10, 7)));
  EXPECT_TRUE(layers_.Miss(key));
}

TEST_F(StaticLayersTest, ALayerIsFoundByItsKey) {
  picture_.tiles().colour[5] = 77;
  layers_.Store({1, 2}, picture_, view_);
  picture_.tiles().colour[5] = 0;
  EXPECT_EQ(layers_.Find({1}), nullptr);
  EXPECT_EQ(layers_.Find({1, 3}), nullptr);
  const TileBuffer* found = layers_.Find({1, 2});
  ASSERT_NE(found, nullptr);
  TileBuffer copy;
  copy.Resize(view_);
  copy.CopyFrom(*found);
  EXPECT_EQ(copy.tiles().colour[5], 77);
}

// 8 MiB are enough for 8 layers of 64 x 64 tiles; the oldest layer is dropped.
TEST_F(StaticLayersTest, MemoryIsLimited) {
  for (uint32_t i = 0; i < 30; ++i) layers_.Store({i}, picture_, view_);
  EXPECT_EQ(layers_.Find({0}), nullptr);
  EXPECT_NE(layers_.Find({29}), nullptr);
  int kept = 0;
  for (uint32_t i = 0; i < 30; ++i) kept += layers_.Find({i}) != nullptr;
  EXPECT_EQ(static_cast<size_t>(kept), (8u << 20) / picture_.bytes());
}

}  // namespace
}  // namespace shoal::worlds::native
