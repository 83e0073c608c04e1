// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/low_poly_shapes.h"

#include <GL/osmesa.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "actor/worlds/engine_handles.h"
#include "actor/worlds/model_loading.h"
#include "tests/support/temporary_folder.h"

namespace shoal::worlds {
namespace {

constexpr int kSide = 84, kSlices = 10;

// Shapes that are turned, thick, thin, seen on their caps and from the side.
constexpr const char* kModel = R"(<mujoco><visual><quality shadowsize="0" offsamples="0"
    numslices="10" numstacks="4"/></visual>
  <asset><texture name="t" type="cube" builtin="checker" rgb1="1 0 0" rgb2="0 0 1" width="8"
                  height="8"/>
    <material name="checker" texture="t"/></asset>
  <worldbody><camera name="c" pos="0 -3 0" xyaxes="1 0 0 0 0 1"/>
    <geom type="cylinder" size="0.3 0.2" pos="-0.7 0 0.6" euler="40 20 0" rgba="1 0.5 0 1"/>
    <geom type="cylinder" size="0.1 0.5" pos="0.6 0 0.7" euler="80 50 10" rgba="0 1 0.5 1"/>
    <geom type="capsule" size="0.2 0.2" pos="-0.7 0 -0.6" euler="-60 10 0" rgba="0.5 0 1 1"/>
    <geom type="capsule" size="0.1 0.4" pos="0.3 0 -0.6" euler="10 30 0" rgba="1 1 0 1"/>
    <geom type="capsule" size="0.1 0.2" pos="0.9 0 -0.6" material="checker"/>
    <geom type="sphere" size="0.15" pos="0 0 0.2"/></worldbody></mujoco>)";

// A model's scene and OSMesa to draw it.
class DrawnScene {
 public:
  DrawnScene() : window_(kSide * kSide * 4) {
    const TemporaryFolder folder;
    const std::string file = folder.path() / "shapes.xml";
    std::ofstream(file) << kModel;
    model_ = LoadModel("", file, "");
    data_ = MakeData(*model_);
    mj_forward(model_.get(), data_.get());
    osmesa_ = OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 8, nullptr);
    OSMesaMakeCurrent(osmesa_, window_.data(), GL_UNSIGNED_BYTE, kSide, kSide);
    model_->vis.global.offwidth = model_->vis.global.offheight = kSide;
    mjr_defaultContext(&context_);
    mjr_makeContext(model_.get(), &context_, mjFONTSCALE_50);
    mjr_setBuffer(mjFB_OFFSCREEN, &context_);
    mjv_defaultScene(&scene_);
    mjv_makeScene(model_.get(), &scene_, 20);
    Update();
  }
  ~DrawnScene() {
    mjr_freeContext(&context_);
    mjv_freeScene(&scene_);
    OSMesaDestroyContext(osmesa_);
  }
  DrawnScene(const DrawnScene&) = delete;
  DrawnScene& operator=(const DrawnScene&) = delete;

  // Lets the engine make its scene of the model.
  void Update() {
    mjvOption option;
    mjv_defaultOption(&option);
    mjvCamera camera;
    mjv_defaultCamera(&camera);
    camera.type = mjCAMERA_FIXED;
    camera.fixedcamid = 0;
    mjv_updateScene(model_.get(), data_.get(), &option, nullptr, &camera, mjCAT_ALL, &scene_);
  }

  mjvScene& scene() { return scene_; }
  const mjrContext& context() const { return context_; }

  std::vector<uint8_t> Draw() {
    const mjrRect viewport{0, 0, kSide, kSide};
    mjr_render(viewport, &scene_, &context_);
    std::vector<uint8_t> pixels(kSide * kSide * 3);
    mjr_readPixels(pixels.data(), nullptr, viewport, &context_);
    return pixels;
  }

 private:
  std::vector<uint8_t> window_;
  ModelHandle model_;
  DataHandle data_;
  OSMesaContext osmesa_ = nullptr;
  mjrContext context_;
  mjvScene scene_;
};

std::vector<int> Types(const mjvScene& scene) {
  std::vector<int> types;
  types.reserve(scene.ngeom);
  for (int i = 0; i < scene.ngeom; ++i) types.push_back(scene.geoms[i].type);
  return types;
}

TEST(LowPolyShapes, LookLikeTheEnginesOwn) {
  DrawnScene drawn;
  const std::vector<uint8_t> before = drawn.Draw();
  LowPolyShapes shapes(kSlices);
  shapes.Replace(drawn.context(), &drawn.scene());
  const std::vector<uint8_t> after = drawn.Draw();
  int differing = 0, lit = 0;
  for (size_t i = 0; i < before.size(); i += 3) {
    int change = 0;
    for (size_t channel = i; channel < i + 3; ++channel) {
      change = std::max(change, std::abs(before[channel] - after[channel]));
    }
    differing += change > 32;

    lit += before[i] + before[i + 1] + before[i + 2] > 0;
  }
  EXPECT_GT(lit, 1000);
  EXPECT_LE(differing, lit / 200);
}

TEST(LowPolyShapes, ReplaceCylindersAndCapsulesWithoutTextureAlone) {
  DrawnScene drawn;
  LowPolyShapes shapes(kSlices);
  shapes.Replace(drawn.context(), &drawn.scene());
  EXPECT_EQ(Types(drawn.scene()), (std::vector<int>{mjGEOM_MESH, mjGEOM_MESH, mjGEOM_MESH,
                                                    mjGEOM_MESH, mjGEOM_CAPSULE, mjGEOM_SPHERE}));
}

TEST(LowPolyShapes, LeaveOvalOnesAsTheyAre) {
  DrawnScene drawn;
  drawn.scene().geoms[0].size[1] *= 2;
  LowPolyShapes(kSlices).Replace(drawn.context(), &drawn.scene());
  EXPECT_EQ(drawn.scene().geoms[0].type, mjGEOM_CYLINDER);
}

// Or every frame would leave lists behind.
TEST(LowPolyShapes, AreCompiledOnce) {
  DrawnScene drawn;
  LowPolyShapes shapes(kSlices);
  std::vector<int> first, second;
  for (std::vector<int>* lists : {&first, &second}) {
    drawn.Update();
    shapes.Replace(drawn.context(), &drawn.scene());
    for (int i = 0; i < 4; ++i) lists->push_back(drawn.scene().geoms[i].dataid);
  }
  EXPECT_EQ(first, second);
  EXPECT_EQ(first[0], first[1]) << "cylinders share a list";
  EXPECT_NE(first[2], first[3]) << "capsules of other proportions do not";
}

}  // namespace
}  // namespace shoal::worlds
