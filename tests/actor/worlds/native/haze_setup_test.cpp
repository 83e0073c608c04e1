// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/haze_setup.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <cstdlib>

#include "common/base/files.h"
#include "tests/actor/worlds/native/scene_by_hand.h"
#include "tests/actor/worlds/pictures/unshadowed_reference.h"
#include "tests/support/temporary_folder.h"

namespace shoal::worlds::native {
namespace {

// The eye is 1 above an endless plane.
class HazeSetup : public testing::Test {
 protected:
  HazeSetup() {
    hand_.Add(mjGEOM_PLANE, {0, 0, -1}, {0, 0, 1});
    hand_.scene().flags[mjRND_HAZE] = 1;
    style_.width = 0.25f;
  }
  // Whether it is seen.
  bool Make() {
    return MakeHaze(hand_.scene(), FrameOf(hand_.scene(), 8, 8), style_, &haze_) && haze_.seen;
  }

  SceneByHand hand_;
  HazeStyle style_;
  Haze haze_{};
};

TEST_F(HazeSetup, IsAConeThatRisesFromThePlaneToTheEye) {
  ASSERT_TRUE(Make());
  EXPECT_FLOAT_EQ(haze_.elevation, 1 / 70.0f) << "the far plane is at 100";
  EXPECT_FLOAT_EQ(haze_.inverse_sky, 1 / 70.0f);
  EXPECT_FLOAT_EQ(haze_.width, 0.25f);
  EXPECT_FLOAT_EQ(haze_.peak, 0.8f);
  // The camera's y is the plane's normal, its z the plane's x.
  EXPECT_FLOAT_EQ(haze_.axes[2][1], 1);
  EXPECT_FLOAT_EQ(haze_.axes[0][2], 1);
}

TEST_F(HazeSetup, OnlyEndlessPlanesBelowTheEyeHaveIt) {
  hand_.geoms()[0].size[1] = 3;
  EXPECT_FALSE(Make()) << "a plane with a size";
  hand_.geoms()[0].size[1] = 0;
  hand_.geoms()[0].pos[2] = 1;
  EXPECT_FALSE(Make()) << "above the eye";
  hand_.Add(mjGEOM_PLANE, {0, 0, -2}, {0, 0, 1});
  EXPECT_FALSE(Make()) << "the first endless plane counts";
  hand_.geoms()[0].type = mjGEOM_BOX;
  EXPECT_TRUE(Make());
}

TEST_F(HazeSetup, ModelsAndScenesMayTurnItOff) {
  style_.width = 0;
  EXPECT_FALSE(Make());
  style_.width = 0.25f;
  hand_.scene().flags[mjRND_HAZE] = 0;
  EXPECT_FALSE(Make());
}

constexpr char kLevel[] = R"(pos="0 0 2" xyaxes="0 -1 0 0 0 1" fovy="50")";
constexpr int kSide = 96;
constexpr size_t kPixels = kSide * kSide;

// A scene below a sky that is drawn by the engine and by us. `camera` and `map` are attributes.
class HazeInPictures {
 public:
  HazeInPictures(const std::string& camera, const std::string& map) {
    const TemporaryFolder folder;
    const std::string file = folder.path() / "model.xml";
    WriteFileAtomically(file, R"(<mujoco><statistic extent="2"/><visual><map )" + map +
                                  R"(/><rgba haze="0.9 0.2 0.4 1"/></visual><asset>
      <texture type="skybox" builtin="gradient" rgb1="0.2 0.4 0.9" rgb2="0 0 0.2" width="64"
               height="384"/>
      <texture name="t" type="2d" builtin="checker" rgb1="0.2 0.6 0.2" rgb2="0.1 0.3 0.1"
               width="64" height="64"/>
      <material name="m" texture="t" texrepeat="0.5 0.5" specular="0" reflectance="0"/></asset>
      <worldbody><light directional="true" dir="0 0.3 -1" castshadow="false"/>
      <geom type="plane" size="0 0 1" material="m"/>
      <geom type="box" pos="9 1 1" size="1 1 1" rgba="1 1 0 1"/>
      <geom type="sphere" pos="6 -1 1" size="0.7" rgba="0 1 1 0.5"/>
      <camera name="c" )" + camera +
                                  R"(/></worldbody></mujoco>)");
    char error[500] = "";
    model_ = mj_loadXML(file.c_str(), nullptr, error, sizeof(error));
    if (model_ == nullptr) throw std::runtime_error(error);
    data_ = mj_makeData(model_);
    mj_forward(model_, data_);
    mjv_defaultScene(&scene_);
    mjv_makeScene(model_, &scene_, 100);
    mjvCamera view;
    mjv_defaultCamera(&view);
    view.type = mjCAMERA_FIXED;
    view.fixedcamid = 0;
    mjvOption option;
    mjv_defaultOption(&option);
    mjv_updateScene(model_, data_, &option, nullptr, &view, mjCAT_ALL, &scene_);
  }
  ~HazeInPictures() {
    mjv_freeScene(&scene_);
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  HazeInPictures(const HazeInPictures&) = delete;
  HazeInPictures& operator=(const HazeInPictures&) = delete;

  std::vector<uint8_t> Reference() {
    return UnshadowedReference(model_, kSide, kSide).Draw(&scene_);
  }
  std::vector<uint8_t> Native(InstructionSet set = WidestInstructionSet()) {
    Renderer renderer(*model_, set);
    std::vector<uint8_t> planes(3 * kPixels);
    // The second frame comes from a layer.
    for (int i = 0; i < 3; ++i) renderer.Draw(scene_, kSide, kSide, planes);
    return planes;
  }
  void TurnOff() { scene_.flags[mjRND_HAZE] = 0; }

 private:
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
  mjvScene scene_;
};

double Difference(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::abs(int{a[i]} - int{b[i]});
  return sum / static_cast<double>(a.size());
}

TEST(HazePictures, AreThoseOfTheEngine) {
  const char* rolled = R"(pos="-1 3 6" xyaxes="0.3 -1 0 0.2 0.1 1" fovy="70")";
  const char* steep = R"(pos="0 0 40" xyaxes="0 -1 0 0.8 0 0.6" fovy="80")";
  const char* below = R"(pos="0 0 -3" xyaxes="0 -1 0 0 0 1" fovy="80")";
  for (const char* camera : {kLevel, rolled, steep, below}) {
    for (const char* map : {R"(haze="0.3")", R"(haze="0.8" zfar="30")"}) {
      for (const bool off : {false, true}) {
        HazeInPictures pictures(camera, map);
        if (off) pictures.TurnOff();
        const std::vector<uint8_t> native = pictures.Native();
        EXPECT_LT(Difference(native, pictures.Reference()), 1.6) << camera << map << off;
        for (const InstructionSet set : SupportedSets()) {
          ASSERT_EQ(pictures.Native(set), native) << camera << map << off;
        }
      }
    }
  }
}

// The engine would draw a band without width on the sky's own cylinder, where the two flicker.
TEST(HazePictures, WithoutWidthThereIsNoHaze) {
  HazeInPictures pictures(kLevel, R"(haze="0.8")");
  const std::vector<uint8_t> with = pictures.Native();
  pictures.TurnOff();
  const std::vector<uint8_t> without = pictures.Native();
  EXPECT_GT(Difference(with, without), 3);
  EXPECT_EQ(HazeInPictures(kLevel, R"(haze="0")").Native(), without);
}

}  // namespace
}  // namespace shoal::worlds::native
