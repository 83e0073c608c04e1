// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/triangle_meshes.h"

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "actor/worlds/model_loading.h"
#include "tests/actor/worlds/native/scene_by_hand.h"
#include "tests/actor/worlds/pictures/unshadowed_reference.h"
#include "tests/support/temporary_folder.h"

namespace shoal::worlds::native {
namespace {

constexpr int kSide = 96;
constexpr size_t kPixels = kSide * kSide;

// A convex mesh, one of sharp and smooth corners, a height field, and textures on all kinds of
// geoms; one mesh reaches behind the eye.
// That one does not shine: the engine would light it at corners that are far apart.
constexpr char kModel[] = R"(<mujoco>
  <visual><map znear="0.01"/></visual>
  <asset>
    <texture name="flat" type="2d" builtin="checker" rgb1="1 0 0" rgb2="0 0 1" width="64"
             height="64"/>
    <texture name="cube" type="cube" builtin="gradient" rgb1="1 1 0" rgb2="0 0.3 1" width="32"
             height="32"/>
    <texture name="sky" type="skybox" builtin="gradient" rgb1="0.4 0.6 0.8" rgb2="0 0 0"
             width="64" height="64"/>
    <material name="flat" texture="flat" texrepeat="3 3" specular="0"/>
    <material name="cube" texture="cube" specular="0.2"/>
    <material name="dull" rgba="0.4 0.4 0.4 1" specular="0"/>
    <mesh name="gem" vertex="1 0 0  -1 0 0  0 1 0  0 -1 0  0 0 1.3  0 0 -1.3" scale="0.3 0.3 0.3"/>
    <mesh name="drum" vertex="1 0 -1  0.81 0.59 -1  0.31 0.95 -1  -0.31 0.95 -1  -0.81 0.59 -1
      -1 0 -1  -0.81 -0.59 -1  -0.31 -0.95 -1  0.31 -0.95 -1  0.81 -0.59 -1
      1 0 1  0.81 0.59 1  0.31 0.95 1  -0.31 0.95 1  -0.81 0.59 1
      -1 0 1  -0.81 -0.59 1  -0.31 -0.95 1  0.31 -0.95 1  0.81 -0.59 1" scale="0.25 0.25 0.4"/>
    <hfield name="hills" nrow="9" ncol="13" size="1.6 1.2 0.4 0.1"/>
  </asset>
  <worldbody>
    <light pos="-4 -12 20" dir="0.2 0.6 -1" cutoff="90" exponent="0"/>
    <light directional="true" dir="1 1 -1" diffuse="0.4 0.4 0.4" castshadow="false"/>
    <camera name="c" pos="0 -3.2 1.6" xyaxes="1 0 0 0 0.4 1"/>
    <geom type="hfield" hfield="hills" pos="0 0 -0.6" rgba="0.5 0.8 0.5 1"/>
    <geom type="mesh" mesh="gem" pos="-0.8 -0.3 0.6" euler="20 30 0" rgba="0.9 0.4 0.1 1"/>
    <geom type="mesh" mesh="drum" pos="0 -0.2 0.7" euler="50 10 0" rgba="0.2 0.5 0.9 1"/>
    <geom type="mesh" mesh="drum" pos="0.8 -0.2 0.5" euler="0 40 0" material="cube"/>
    <geom type="mesh" mesh="gem" pos="0.1 -3 1.2" euler="10 0 0" material="dull"/>
    <geom type="box" size="0.2 0.2 0.2" pos="-0.8 0 1.3" euler="20 30 40" material="flat"/>
    <geom type="sphere" size="0.22" pos="-0.2 0 1.4" material="cube"/>
    <geom type="ellipsoid" size="0.3 0.2 0.15" pos="0.4 0 1.4" euler="20 30 40" material="flat"/>
    <geom type="cylinder" size="0.15 0.2" pos="0.9 0 1.3" euler="70 30 0" material="cube"/>
    <geom type="capsule" size="0.1 0.2" pos="1.3 0 0.9" euler="30 30 0" material="cube"/>
  </worldbody></mujoco>)";

class TriangleMeshesTest : public testing::Test {
 protected:
  TriangleMeshesTest() {
    const TemporaryFolder folder;
    const std::string file = folder.path() / "meshes.xml";
    std::ofstream(file) << kModel;
    model_ = LoadModel("", file, "");
    for (int i = 0; i < model_->hfield_nrow[0] * model_->hfield_ncol[0]; ++i) {
      model_->hfield_data[i] = static_cast<float>(0.5 + 0.5 * std::sin(i * 1.7));
    }
    data_ = MakeData(*model_);
    mj_forward(model_.get(), data_.get());
    mjv_defaultScene(&scene_);
    mjv_makeScene(model_.get(), &scene_, 100);
    mjv_defaultOption(&option_);
    Update();
  }
  ~TriangleMeshesTest() override { mjv_freeScene(&scene_); }

  void Update() {
    mjvCamera camera;
    mjv_defaultCamera(&camera);
    camera.type = mjCAMERA_FIXED;
    camera.fixedcamid = 0;
    mjv_updateScene(model_.get(), data_.get(), &option_, nullptr, &camera, mjCAT_ALL, &scene_);
  }

  // Mean difference from the engine's own picture, and the share of pixels with the same geom.
  std::pair<double, double> Compare() {
    UnshadowedReference reference(model_.get(), kSide, kSide);
    Renderer renderer(*model_);
    std::vector<uint8_t> ours(3 * kPixels);
    renderer.Draw(scene_, kSide, kSide, ours);
    const std::vector<uint8_t> theirs = reference.Draw(&scene_);
    double sum = 0;
    for (size_t i = 0; i < ours.size(); ++i) sum += std::abs(int{ours[i]} - int{theirs[i]});
    std::vector<int32_t> numbers(kPixels);
    renderer.DrawNumbers(scene_, kSide, kSide, numbers);
    const std::vector<int> segments = reference.DrawSegments(&scene_);
    double same = 0;
    for (size_t i = 0; i < kPixels; ++i) {
      same += (numbers[i] < 0 ? -1 : scene_.geoms[numbers[i]].segid) == segments[i];
    }
    return {sum / static_cast<double>(ours.size()), same / static_cast<double>(kPixels)};
  }

  ModelHandle model_;
  DataHandle data_;
  mjvScene scene_;
  mjvOption option_;
};

TEST_F(TriangleMeshesTest, MeshesAndHeightFieldsLookAsTheEngineDrawsThem) {
  const auto [difference, same] = Compare();
  std::cout << fmt::format("{:.2f} grey levels, {:.4f} of the geoms\n", difference, same);
  EXPECT_LE(difference, 1.5);
  EXPECT_GE(same, 0.99);
}

TEST_F(TriangleMeshesTest, ConvexHullsAreDrawnWhereTheSceneShowsThem) {
  option_.flags[mjVIS_CONVEXHULL] = 1;
  Update();
  const auto [difference, same] = Compare();
  EXPECT_LE(difference, 1.5);
  EXPECT_GE(same, 0.99);
}

TEST_F(TriangleMeshesTest, AllInstructionSetsDrawTheSameBits) {
  std::vector<uint8_t> first(3 * kPixels), other(3 * kPixels);
  Renderer(*model_, InstructionSet::kSse2).Draw(scene_, kSide, kSide, first);
  for (const InstructionSet set : SupportedSets()) {
    Renderer(*model_, set).Draw(scene_, kSide, kSide, other);
    EXPECT_EQ(other, first) << static_cast<int>(set);
  }
}

// The far side of a closed mesh is hidden, and its edges leave no holes.
TEST_F(TriangleMeshesTest, AMeshBeforeTheEyeHasNoHoles) {
  for (int i = 0; i < model_->ngeom; ++i) model_->geom_group[i] = i == 1 ? 0 : 5;
  const int camera = 0;
  for (int k = 0; k < 3; ++k) model_->cam_pos[3 * camera + k] = 0;
  for (int turn = 0; turn < 20; ++turn) {
    // The gem fills the view.
    const mjtNum axis[] = {0.3, 0.5, 0.8};
    mju_axisAngle2Quat(model_->geom_quat + 4, axis, 0.3 * turn);
    const mjtNum to[] = {0, 0, -0.45};
    mju_copy3(model_->geom_pos + 3, to);
    mju_zero(model_->cam_quat, 4);
    model_->cam_quat[0] = 1;
    model_->cam_fovy[0] = 5;
    mj_forward(model_.get(), data_.get());
    Update();
    Renderer renderer(*model_);
    std::vector<int32_t> numbers(kPixels);
    renderer.DrawNumbers(scene_, kSide, kSide, numbers);
    EXPECT_EQ(std::ranges::count(numbers, -1), 0) << "turn " << turn;
  }
}

}  // namespace
}  // namespace shoal::worlds::native
