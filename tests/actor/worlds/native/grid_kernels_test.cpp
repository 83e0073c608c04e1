// SPDX-License-Identifier: Apache-2.0
// Light on the grids of floors.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <memory>
#include <vector>

#include "actor/worlds/native/renderer.h"
#include "common/base/random.h"
#include "tests/actor/worlds/native/scene_by_hand.h"

namespace shoal::worlds::native {
namespace {

constexpr int kWidth = 53, kHeight = 40;

// A floor of 42 x 17 cells under a lamp that is near to it.
class GridKernels : public testing::Test {
 protected:
  GridKernels() {
    model_.ngeom = 1;
    model_.geom_type = &type_;
    model_.geom_size = size_;
    model_.geom_matid = model_.geom_dataid = &none_;
    model_.vis.map.zfar = 50;
    model_.stat.extent = 2;
    mjvGeom& floor = hand_.Add(mjGEOM_PLANE, {0, 0, 0},
                               {static_cast<float>(size_[0]), static_cast<float>(size_[1]), 0.1f});
    floor.dataid = 0;
    floor.specular = floor.shininess = 0.5f;
    hand_.scene().nlight = 2;
    mjvLight& lamp = hand_.scene().lights[1];
    lamp = hand_.scene().lights[0];
    lamp.headlight = lamp.directional = 0;
    lamp.cutoff = 60;
    lamp.exponent = 3;
    lamp.dir[0] = 0;
    lamp.dir[2] = -1;
  }

  // The eye, the lamp and its colour, at random.
  void Move(Random* random) {
    const auto draw = [random](double low, double high) {
      return static_cast<float>(random->Uniform(low, high));
    };
    mjvGLCamera& camera = hand_.scene().camera[0];
    camera.pos[0] = draw(-4, 4);
    camera.pos[1] = draw(-2, 2);
    camera.pos[2] = draw(0.3, 4);
    for (int i = 0; i < 3; ++i) {
      camera.forward[i] = i == 2 ? draw(-1, -0.1) : draw(-1, 1);
      camera.up[i] = i == 2 ? 1 : draw(-1, 1);
    }
    hand_.scene().camera[1] = camera;
    mjvLight& lamp = hand_.scene().lights[1];
    lamp.pos[0] = draw(-4, 4);
    lamp.pos[1] = draw(-2, 2);
    lamp.pos[2] = draw(0.5, 3);
    lamp.diffuse[0] = draw(0, 1) < 0.5f ? 0.7f : 0.2f;  // grey or not
  }

  std::vector<uint8_t> Draw(Renderer& renderer) {
    std::vector<uint8_t> planes(size_t{3} * kWidth * kHeight);
    renderer.Draw(hand_.scene(), kWidth, kHeight, planes);
    return planes;
  }

  mjModel model_ = EmptyModel();
  int type_ = mjGEOM_PLANE, none_ = -1;
  mjtNum size_[3] = {4, 1.55, 0.1};
  SceneByHand hand_;
};

// Every corner of a cell that is seen is lit for the frame: what earlier frames left in the grid,
// or its first zeros, is not seen.
TEST_F(GridKernels, LightOfEarlierFramesIsNotSeen) {
  std::vector<std::unique_ptr<Renderer>> used;
  for (const InstructionSet set : SupportedSets()) {
    used.push_back(std::make_unique<Renderer>(model_, set));
  }
  Random random(3);
  int bright = 0;
  for (int frame = 0; frame < 150; ++frame) {
    Move(&random);
    Renderer fresh(model_, InstructionSet::kSse2);
    const std::vector<uint8_t> expected = Draw(fresh);
    for (const auto& renderer : used) ASSERT_EQ(Draw(*renderer), expected) << "frame " << frame;
    for (const uint8_t v : expected) bright += v > 200;
  }
  EXPECT_GT(bright, 10'000) << "the lamp is hardly seen";
}

}  // namespace
}  // namespace shoal::worlds::native
