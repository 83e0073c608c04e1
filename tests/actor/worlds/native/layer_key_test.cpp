// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/layer_key.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/actor/worlds/native/scene_by_hand.h"

namespace shoal::worlds::native {
namespace {

StaticLayers::Key KeyOf(mjvScene& scene, int width = 64) {
  View view{};
  view.width = width;
  view.height = 64;
  const int fixed[] = {0};
  StaticLayers::Key key;
  MakeLayerKey(scene, FrameOf(scene, width, 64), view, fixed, &key);
  return key;
}

class LayerKeyTest : public testing::Test {
 protected:
  LayerKeyTest() {
    hand_.Add(mjGEOM_BOX, {3, 0, 0}, {1, 1, 1});
    hand_.Add(mjGEOM_BOX, {4, 0, 0}, {1, 1, 1});
    hand_.scene().lights[0].headlight = 0;
  }

  SceneByHand hand_;
};

TEST_F(LayerKeyTest, ChangesWithAllThatALayerShows) {
  const StaticLayers::Key before = KeyOf(hand_.scene());
  using Change = std::function<void(mjvScene&)>;
  const Change changes[] = {
      [](mjvScene& s) { s.camera[0].pos[1] = 1; },
      [](mjvScene& s) { s.camera[0].frustum_far = 50; },
      [](mjvScene& s) { s.nlight = 2; },
      [](mjvScene& s) { s.lights[0].attenuation[2] = 1; },
      [](mjvScene& s) { s.lights[0].specular[2] = 1; },
      [](mjvScene& s) { s.lights[0].directional = 0; },
      [](mjvScene& s) { s.lights[0].castshadow = 1; },
      [](mjvScene& s) { s.lights[0].pos[2] = 1; },
      [](mjvScene& s) { s.lights[0].dir[2] = 1; },
      [](mjvScene& s) { s.geoms[0].type = mjGEOM_CYLINDER; },
      [](mjvScene& s) { s.geoms[0].dataid = 3; },
      [](mjvScene& s) { s.geoms[0].texid = 3; },
      [](mjvScene& s) { s.geoms[0].texuniform = 1; },
      [](mjvScene& s) { s.geoms[0].texcoord = 1; },
      [](mjvScene& s) { s.geoms[0].texrepeat[0] = 2; },
      [](mjvScene& s) { s.geoms[0].size[2] = 2; },
      [](mjvScene& s) { s.geoms[0].mat[8] = 2; },
      [](mjvScene& s) { s.geoms[0].rgba[2] = 0.5f; },
      [](mjvScene& s) { s.geoms[0].emission = 1; },
      [](mjvScene& s) { s.geoms[0].shininess = 1; },
  };
  for (const Change& change : changes) {
    const mjvScene scene = hand_.scene();
    const mjvGeom geom = hand_.geoms()[0];
    change(hand_.scene());
    EXPECT_NE(KeyOf(hand_.scene()), before) << "change " << &change - changes;
    hand_.scene() = scene;
    hand_.geoms()[0] = geom;
    ASSERT_EQ(KeyOf(hand_.scene()), before);
  }
  EXPECT_NE(KeyOf(hand_.scene(), 65), before);
}

TEST_F(LayerKeyTest, StaysWhenOtherGeomsMove) {
  const StaticLayers::Key before = KeyOf(hand_.scene());
  hand_.geoms()[1].pos[0] = 9;
  EXPECT_EQ(KeyOf(hand_.scene()), before);
}

}  // namespace
}  // namespace shoal::worlds::native
