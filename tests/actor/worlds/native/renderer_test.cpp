// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/renderer.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/base/error.h"
#include "common/base/random.h"
#include "tests/actor/worlds/native/scene_by_hand.h"

namespace shoal::worlds::native {
namespace {

using testing::HasSubstr;

class RendererTest : public testing::Test {
 protected:
  std::vector<uint8_t> Draw(int width = 64, int height = 64) {
    return DrawWith(renderer_, width, height);
  }
  std::vector<uint8_t> DrawWith(Renderer& renderer, int width, int height) {
    std::vector<uint8_t> planes(3 * static_cast<size_t>(width) * static_cast<size_t>(height), 7);
    renderer.Draw(hand_.scene(), width, height, planes);
    return planes;
  }
  std::vector<int32_t> Numbers(int width = 64, int height = 64) {
    std::vector<int32_t> numbers(static_cast<size_t>(width) * static_cast<size_t>(height));
    renderer_.DrawNumbers(hand_.scene(), width, height, numbers);
    return numbers;
  }
  // Pixels that show anything.
  int Covered() {
    const std::vector<int32_t> numbers = Numbers();
    return static_cast<int>(std::ranges::count_if(numbers, [](int n) { return n >= 0; }));
  }

  // Geoms of all kinds, colours and poses in front of the eye.
  void AddRandomGeoms(int count, uint64_t seed, bool transparent = false) {
    Random random(seed);
    constexpr int kTypes[] = {mjGEOM_SPHERE,   mjGEOM_CAPSULE, mjGEOM_ELLIPSOID,
                              mjGEOM_CYLINDER, mjGEOM_BOX,     mjGEOM_PLANE};
    const auto draw = [&random](double low, double high) {
      return static_cast<float>(random.Uniform(low, high));
    };
    for (int i = 0; i < count; ++i) {
      const int type = kTypes[i % 6];
      // Drawn one after the other: compilers differ in the order of a call's arguments.
      const std::array size{draw(0.05, 0.6), draw(0.05, 0.6), draw(0.05, 0.6)};
      const std::array position{draw(0.5, 6), draw(-2, 2), draw(-2, 2)};
      mjvGeom& geom = hand_.Add(type, position, size);
      if (type == mjGEOM_SPHERE) geom.size[1] = geom.size[2] = geom.size[0];
      if (type == mjGEOM_CAPSULE || type == mjGEOM_CYLINDER) geom.size[1] = geom.size[0];
      mjtNum quat[4] = {draw(-1, 1), draw(-1, 1), draw(-1, 1), draw(-1, 1)}, mat[9];
      mju_normalize4(quat);
      mju_quat2Mat(mat, quat);
      mju_n2f(geom.mat, mat, 9);
      for (int c = 0; c < 3; ++c) geom.rgba[c] = draw(0, 1);
      if (transparent) geom.rgba[3] = draw(0.1, 0.9);
      geom.specular = draw(0, 1);
      geom.shininess = draw(0, 1);
      geom.emission = i % 4 == 0 ? 0.3f : 0;
    }
  }

  mjModel model_ = EmptyModel();
  SceneByHand hand_;
  Renderer renderer_{model_};
};

// A pixel whose centre is inside the silhouette's circle is covered, and no other.
TEST_F(RendererTest, ASpheresSilhouetteIsItsTangentCone) {
  constexpr int kSide = 101;
  for (const auto& [y, z, radius] : {std::array{0.0f, 0.0f, 0.5f}, std::array{0.3f, -0.4f, 0.25f},
                                     std::array{-0.9f, 0.6f, 0.9f}}) {
    hand_.geoms().clear();
    hand_.Add(mjGEOM_SPHERE, {3, y, z}, {radius, radius, radius});
    const std::vector<int32_t> numbers = Numbers(kSide, kSide);
    const double distance2 = 9.0 + y * y + z * z;
    int near_edge = 0;
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) {
        const double right = (column + 0.5) / kSide - 0.5, up = 0.5 - (row + 0.5) / kSide;
        // Along (1, -right, up); +y is on the left.
        const double along = 3 - right * y + up * z;
        const double sine2 = 1 - along * along / ((1 + right * right + up * up) * distance2);
        const double limit = double{radius} * radius / distance2;
        if (std::fabs(sine2 / limit - 1) < 1e-4) {
          ++near_edge;
          continue;
        }
        ASSERT_EQ(numbers[static_cast<size_t>(row * kSide + column)] == 0, sine2 < limit)
            << row << " " << column << " of a sphere at " << y << " " << z;
      }
    }
    EXPECT_LE(near_edge, 2);
  }
}

TEST_F(RendererTest, DepthIsThatOfTheSurface) {
  hand_.Add(mjGEOM_BOX, {3, 0, 0}, {0.5f, 4, 4});
  std::vector<float> depths(64 * 64);
  renderer_.DrawDepth(hand_.scene(), 64, 64, depths);
  for (const float depth : depths) ASSERT_NEAR(depth, 2.5f, 1e-5f);
  hand_.geoms().clear();
  renderer_.DrawDepth(hand_.scene(), 64, 64, depths);
  for (const float depth : depths) ASSERT_EQ(depth, std::numeric_limits<float>::infinity());
}

// Light along the gaze on a white face: ambient 0.2 + diffuse 0.7.
TEST_F(RendererTest, AFaceTowardsTheLightHasItsColour) {
  hand_.Add(mjGEOM_BOX, {3, 0, 0}, {0.5f, 4, 4}).rgba[2] = 0.5f;
  const std::vector<uint8_t> planes = Draw();
  for (size_t i = 0; i < 64 * 64; ++i) {
    ASSERT_EQ(planes[i], 230);                // 0.9 * 255 = 229.5
    ASSERT_EQ(planes[2 * 64 * 64 + i], 115);  // 0.45 * 255 = 114.75
  }
}

TEST_F(RendererTest, RowZeroIsTheTopAndColumnZeroTheLeft) {
  hand_.Add(mjGEOM_SPHERE, {3, 1, 1}, {0.2f, 0.2f, 0.2f});  // +y is on the left
  const std::vector<int32_t> numbers = Numbers();
  const auto first = std::ranges::find(numbers, 0) - numbers.begin();
  ASSERT_LT(first, 64 * 64);
  EXPECT_LT(first / 64, 32);
  EXPECT_LT(first % 64, 32);
}

TEST_F(RendererTest, NothingBehindTheEyeOrBeforeTheNearPlaneIsSeen) {
  for (const int type :
       {mjGEOM_SPHERE, mjGEOM_CAPSULE, mjGEOM_ELLIPSOID, mjGEOM_CYLINDER, mjGEOM_BOX}) {
    hand_.geoms().clear();
    hand_.Add(type, {-2, 0, 0}, {0.5f, 0.5f, 0.5f});
    EXPECT_EQ(Covered(), 0) << "behind, type " << type;
    hand_.geoms()[0].pos[0] = 0.05f;
    for (float& size : hand_.geoms()[0].size) size = 0.02f;
    EXPECT_EQ(Covered(), 0) << "before the near plane, type " << type;
    // Around the eye: only backs, which the engine does not draw.
    hand_.geoms()[0].pos[0] = 0;
    for (float& size : hand_.geoms()[0].size) size = 3;
    EXPECT_EQ(Covered(), 0) << "around the eye, type " << type;
    hand_.geoms()[0].pos[0] = 3.5f;
    EXPECT_EQ(Covered(), 64 * 64) << "right before the eye, type " << type;
  }
}

// The near plane cuts the front off; the back is not drawn.
TEST_F(RendererTest, AShapeAcrossTheNearPlaneIsOpenInFront) {
  for (const int type : {mjGEOM_SPHERE, mjGEOM_CAPSULE, mjGEOM_ELLIPSOID, mjGEOM_CYLINDER}) {
    hand_.geoms().clear();
    hand_.Add(type, {0.16f, 0, 0}, {0.07f, 0.07f, 0.07f});
    std::vector<float> depths(65 * 65);
    renderer_.DrawDepth(hand_.scene(), 65, 65, depths);
    EXPECT_EQ(depths[32 * 65 + 32], std::numeric_limits<float>::infinity()) << type;
    EXPECT_GE(std::ranges::min(depths), 0.1f) << type;
    EXPECT_GT(Covered(), 50) << type;
  }
}

// A floor below an eye that is level ends at the horizon, in the middle of the picture.
TEST_F(RendererTest, AnEndlessPlaneReachesTheFarPlane) {
  hand_.Add(mjGEOM_PLANE, {0, 0, -1}, {0, 0, 1});
  const std::vector<int32_t> numbers = Numbers();
  for (size_t row = 0; row < 64; ++row) {
    // The plane is 1 below: seen at depth 1 / slope, up to 100.
    const double slope = (static_cast<double>(row) + 0.5) / 64 - 0.5;
    ASSERT_EQ(numbers[row * 64 + 20] == 0, slope > 0.01) << row;
  }
}

TEST_F(RendererTest, APlaneFromBehindIsNearlyTransparent) {
  mjvGeom& plane = hand_.Add(mjGEOM_PLANE, {3, 0, 0}, {9, 9, 1});
  plane.mat[0] = plane.mat[8] = 0;
  plane.mat[2] = -1;  // z axis: -x, towards the eye
  plane.mat[6] = 1;
  EXPECT_EQ(Draw()[0], 230);
  plane.mat[2] = 1;  // z axis: +x
  plane.mat[6] = -1;
  // Twice 0.3 of the ambient 0.2 (51) over black: 15.3, then 0.3 * 51 + 0.7 * 15.
  EXPECT_EQ(Draw()[0], 26);
}

TEST_F(RendererTest, SurfacesThatDoNotMeetAreSeenInAnyOrder) {
  Random random(3);
  for (int i = 0; i < 30; ++i) {
    const auto at = [&] { return static_cast<float>(random.Uniform(-1, 1)); };
    mjvGeom& geom =
        hand_.Add(i % 2 ? mjGEOM_SPHERE : mjGEOM_BOX,
                  {1.5f + 0.3f * static_cast<float>(i), at(), at()}, {0.1f, 0.1f, 0.1f});
    for (int c = 0; c < 3; ++c) geom.rgba[c] = static_cast<float>(random.Uniform(0, 1));
  }
  const std::vector<uint8_t> in_order = Draw();
  std::ranges::reverse(hand_.geoms());
  EXPECT_EQ(Draw(), in_order);
  std::rotate(hand_.geoms().begin(), hand_.geoms().begin() + 7, hand_.geoms().end());
  EXPECT_EQ(Draw(), in_order);
}

TEST_F(RendererTest, AllInstructionSetsDrawTheSameBits) {
  ASSERT_GE(SupportedSets().size(), 1u);
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    hand_.geoms().clear();
    AddRandomGeoms(60, seed, /*transparent=*/seed % 3 == 0);
    Renderer reference(model_, InstructionSet::kSse2);
    const std::vector<uint8_t> expected = DrawWith(reference, 83, 61);
    for (const InstructionSet set : SupportedSets()) {
      Renderer renderer(model_, set);
      ASSERT_EQ(DrawWith(renderer, 83, 61), expected)
          << "seed " << seed << ", set " << static_cast<int>(set);
    }
  }
}

// Planes under directional lights are lit once and then only where they shine. With a lamp that is
// not directional each pixel is lit, here by a lamp without light.
TEST_F(RendererTest, PlanesAreLitOnceAsEachPixelIs) {
  Random random(5);
  for (int scene = 0; scene < 40; ++scene) {
    hand_.geoms().clear();
    AddRandomGeoms(30, 100 + static_cast<uint64_t>(scene));
    std::erase_if(hand_.geoms(), [](const mjvGeom& geom) {
      return geom.type != mjGEOM_BOX && geom.type != mjGEOM_PLANE;
    });
    for (mjvGeom& geom : hand_.geoms()) geom.shininess = 0.12f + 0.88f * geom.shininess;
    mjvScene& made = hand_.scene();
    made.nlight = 3;
    for (int i = 1; i < 3; ++i) {
      made.lights[i] = made.lights[0];
      made.lights[i].headlight = 0;
      made.lights[i].castshadow = i == 2;
      for (float& v : made.lights[i].dir) v = static_cast<float>(random.Uniform(-1, 1));
    }
    mjvLight& dark = made.lights[3];
    dark = {};
    dark.attenuation[0] = 1;
    dark.cutoff = 45;
    const std::vector<uint8_t> at_once = Draw();
    made.nlight = 4;
    ASSERT_EQ(Draw(), at_once) << "scene " << scene;
  }
}

// Frames as they were drawn when the test was written; other bits are another quality `native`.
TEST_F(RendererTest, FramesAreTheRecordedOnes) {
  const auto hash = [](const std::vector<uint8_t>& frame) {
    return HashBytes(reinterpret_cast<const char*>(frame.data()), frame.size());
  };
  AddRandomGeoms(60, 1);
  EXPECT_EQ(fmt::format("{:016x}", hash(Draw(84, 84))), "f5f2ba81de470b1d");
  AddRandomGeoms(12, 2, /*transparent=*/true);
  EXPECT_EQ(fmt::format("{:016x}", hash(Draw(84, 84))), "e88c979216e42de6");
}

// A second frame of the same scene comes from a kept layer, a third moves before it.
TEST_F(RendererTest, LayersOfWhatIsFixedChangeNoBit) {
  AddRandomGeoms(30, 4);
  for (size_t i = 0; i < 30; i += 2) hand_.geoms()[i].category = mjCAT_STATIC;
  Renderer anew(model_);
  anew.KeepLayers(false);
  for (int frame = 0; frame < 6; ++frame) {
    hand_.geoms()[1].pos[1] += 0.1f;
    if (frame == 4) hand_.geoms()[2].rgba[0] = 0.5f;
    ASSERT_EQ(Draw(), DrawWith(anew, 64, 64)) << "frame " << frame;
  }
}

TEST_F(RendererTest, BodiesWithoutExtentAreNotSeen) {
  for (const int type : {mjGEOM_SPHERE, mjGEOM_CAPSULE, mjGEOM_ELLIPSOID, mjGEOM_CYLINDER}) {
    hand_.geoms().clear();
    hand_.Add(type, {3, 0, 0}, {0, 0, 0});
    EXPECT_EQ(Covered(), 0) << type;
    hand_.geoms()[0].size[0] = hand_.geoms()[0].size[1] = 1e-20f;
    hand_.geoms()[0].size[2] = 1e-20f;
    Draw();
  }
}

// Sizes, places, colours and cameras of all magnitudes, frames that are not orthonormal: every
// scene is drawn with the same bits by all instruction sets, or refused by all. Sanitizers watch.
TEST_F(RendererTest, FuzzedScenesAreDrawnAlikeOrRefused) {
  Random random(77);
  const auto any = [&random](double most_exponent) {
    const double magnitude = std::pow(10, random.Uniform(-most_exponent, most_exponent));
    return static_cast<float>(random.Uniform(0, 1) < 0.5 ? magnitude : -magnitude);
  };
  constexpr int kTypes[] = {mjGEOM_SPHERE,   mjGEOM_CAPSULE, mjGEOM_ELLIPSOID,
                            mjGEOM_CYLINDER, mjGEOM_BOX,     mjGEOM_PLANE};
  int drawn = 0;
  for (int scene = 0; scene < 400; ++scene) {
    hand_.geoms().clear();
    const double range = scene % 4 == 0 ? 18 : scene % 4;
    for (int i = 0; i < 12; ++i) {
      mjvGeom& geom = hand_.Add(kTypes[random.Below(6)], {any(range), any(range), any(range)},
                                {any(range), any(range), any(range)});
      for (float& v : geom.mat) v = scene % 2 == 0 ? any(range / 2) : v;
      for (float& v : geom.rgba) v = std::fabs(any(0.5));
      geom.category = i % 2 == 0 ? mjCAT_STATIC : mjCAT_DYNAMIC;
      geom.specular = std::fabs(any(1));
      geom.shininess = std::fabs(any(range));
      if (i == 5 && scene % 7 == 0) geom.size[1] = std::numeric_limits<float>::denorm_min();
    }
    mjvGLCamera& camera = hand_.scene().camera[0];
    camera.frustum_near = std::fabs(any(range / 2));
    camera.frustum_top = camera.frustum_near * std::fabs(any(1));
    camera.frustum_bottom = -camera.frustum_top;
    hand_.scene().camera[1] = camera;
    std::vector<std::vector<uint8_t>> frames;
    int refused = 0;
    const std::vector<InstructionSet> sets = SupportedSets();
    for (const InstructionSet set : sets) {
      Renderer renderer(model_, set);
      try {
        frames.push_back(DrawWith(renderer, 21, 13));
      } catch (const Error&) {
        ++refused;
      }
    }
    ASSERT_TRUE(refused == 0 || frames.empty()) << "scene " << scene;
    for (const auto& frame : frames) ASSERT_EQ(frame, frames[0]) << "scene " << scene;
    drawn += refused == 0;
  }
  EXPECT_GT(drawn, 200);
}

TEST_F(RendererTest, RefusesWhatIsNotFinite) {
  hand_.Add(mjGEOM_SPHERE, {3, 0, 0}, {1, 1, 1});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto refused = [this](const char* part) {
    try {
      Draw();
      ADD_FAILURE() << "drawn";
    } catch (const Error& error) {
      EXPECT_EQ(error.exit_code(), 3);
      EXPECT_THAT(error.what(), HasSubstr(part));
    }
  };
  hand_.geoms()[0].pos[1] = nan;
  refused("geom 0 of the scene");
  hand_.geoms()[0].pos[1] = 0;
  hand_.geoms()[0].mat[4] = std::numeric_limits<float>::infinity();
  refused("geom 0 of the scene");
  hand_.geoms()[0].mat[4] = 1;
  hand_.scene().camera[0].pos[2] = nan;
  refused("the camera");
}

TEST_F(RendererTest, RefusesGeomsThatItDoesNotDrawByTheirNumber) {
  hand_.Add(mjGEOM_SPHERE, {3, 0, 0}, {1, 1, 1});
  hand_.Add(mjGEOM_ARROW, {3, 0, 0}, {1, 1, 1});
  try {
    Draw();
    FAIL() << "drawn";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("geom 1 of the scene"));
  }
}

TEST_F(RendererTest, PicturesOfOnePixelAndOf4096AreDrawn) {
  hand_.Add(mjGEOM_SPHERE, {3, 0, 0}, {1, 1, 1});
  EXPECT_GT(Draw(1, 1)[0], 200);
  EXPECT_EQ(Draw(1, 1).size(), 3u);
  const std::vector<int32_t> numbers = Numbers(4096, 4096);
  const auto seen = static_cast<double>(std::ranges::count(numbers, 0));
  // The silhouette's half angle has the sine 1/3, so its radius is 1/sqrt(8) of the view's height.
  EXPECT_NEAR(seen / (4096.0 * 4096.0), std::numbers::pi / 8, 1e-4);
}

TEST_F(RendererTest, TenThousandGeomsAreDrawn) {
  AddRandomGeoms(10'000, 9);
  const std::vector<int32_t> numbers = Numbers();
  EXPECT_GT(std::ranges::max(numbers), 5'000);
  Draw();
}

}  // namespace
}  // namespace shoal::worlds::native
