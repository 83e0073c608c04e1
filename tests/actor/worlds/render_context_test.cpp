// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/render_context.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <set>

#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/fetch_reach.h"
#include "actor/worlds/world_registry.h"
#include "common/base/error.h"
#include "tests/support/paths.h"

namespace shoal::worlds {
namespace {

constexpr int kSide = 84;
constexpr size_t kPlane = kSide * kSide;

using Frame = std::vector<uint8_t>;  // (3, 84, 84)

struct Pixel {
  double x = 0, y = 0;  // column and row from the top left, in pixels
};

ObservationConfig Observation(const std::string& quality, bool grey = false) {
  ObservationConfig observation;
  observation.height = observation.width = kSide;
  observation.quality = quality;
  observation.grey = grey;
  return observation;
}

Frame Render(RenderContext* context, World* world, const std::string& camera) {
  context->Attach(world);
  Frame frame(static_cast<size_t>(context->channels_per_camera()) * kPlane);
  const CameraView view = FindCamera(*world, camera);
  context->Render(world, {&view, 1}, frame);
  return frame;
}

double MeanAbsoluteError(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.size(), b.size());
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::abs(int{a[i]} - int{b[i]});
  return sum / static_cast<double>(a.size());
}

// Pixel at which a pinhole camera with these angles sees a point.
Pixel Project(const CameraView& camera, const std::array<double, 3>& point) {
  const double azimuth = camera.azimuth_degrees * M_PI / 180;
  const double elevation = camera.elevation_degrees * M_PI / 180;
  const std::array<double, 3> forward{std::cos(elevation) * std::cos(azimuth),
                                      std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
  const std::array<double, 3> right{std::sin(azimuth), -std::cos(azimuth), 0};
  const std::array<double, 3> up{-std::sin(elevation) * std::cos(azimuth),
                                 -std::sin(elevation) * std::sin(azimuth), std::cos(elevation)};
  double depth = camera.distance, x = 0, y = 0;
  for (size_t i = 0; i < 3; ++i) {
    const double offset = point[i] - camera.lookat[i];
    depth += forward[i] * offset;
    x += right[i] * offset;
    y += up[i] * offset;
  }
  const double focal = kSide / 2.0 / std::tan(22.5 * M_PI / 180);
  return {kSide / 2.0 + focal * x / depth, kSide / 2.0 - focal * y / depth};
}

// Centre of the red pixels. Pixels with red and blue exchanged do not count as red.
std::optional<Pixel> RedCentre(const Frame& frame, int* count) {
  Pixel sum;
  *count = 0;
  for (size_t i = 0; i < kPlane; ++i) {
    const int red = frame[i], green = frame[kPlane + i], blue = frame[2 * kPlane + i];
    if (red < 90 || red < 2 * green || red < 2 * blue) continue;
    const size_t row = i / kSide, column = i % kSide;
    sum.x += static_cast<double>(column) + 0.5;
    sum.y += static_cast<double>(row) + 0.5;
    ++*count;
  }
  if (*count == 0) return std::nullopt;
  return Pixel{sum.x / *count, sum.y / *count};
}

// Rows count from the top, columns from the left, and red is red: each would be wrong elsewhere.
TEST(RenderContext, TheTargetIsRedAndWhereItsGoalProjects) {
  FetchReach world;
  RenderContext context(Observation("fast"));
  for (const char* camera : {"front", "side", "close"}) {
    // Off centre in both directions for each camera, and not behind the gripper.
    for (const std::array<double, 3> goal :
         {std::array<double, 3>{1.47, 0.88, 0.45}, {1.23, 0.63, 0.43}, {1.47, 0.63, 0.62}}) {
      world.ResetTo(goal);
      int count = 0;
      const auto seen = RedCentre(Render(&context, &world, camera), &count);
      ASSERT_TRUE(seen.has_value()) << camera;
      const Pixel expected = Project(FindCamera(world, camera), goal);
      EXPECT_NEAR(seen->x, expected.x, 0.8) << camera;
      EXPECT_NEAR(seen->y, expected.y, 0.8) << camera;
    }
  }
}

// Planes are drawn with wider grids than the model asks for; the model itself stays.
TEST(RenderContext, AttachingChangesNoSizes) {
  const std::unique_ptr<World> world = MakeWorld("Hopper-v5", {});
  const mjModel& model = world->model();
  const std::vector<mjtNum> before(model.geom_size, model.geom_size + 3 * model.ngeom);
  RenderContext(Observation("fast")).Attach(world.get());
  EXPECT_EQ(std::vector<mjtNum>(model.geom_size, model.geom_size + 3 * model.ngeom), before);
}

TEST(RenderContextDeathTest, TexturesThatWereReleasedAreNotUploaded) {
  const std::unique_ptr<World> world = MakeWorld("Hopper-v5", {});
  world->ReleaseTextures();
  RenderContext context(Observation("fast"));
  EXPECT_DEATH(context.Attach(world.get()), "without textures");
}

class DefaultCameras : public testing::TestWithParam<const char*> {};

// The gripper or the object may hide the goal from one camera, as in the original, but rarely from
// both.
TEST_P(DefaultCameras, ShowTheTargetInOneOfThemWhereverItIs) {
  const std::unique_ptr<World> world = MakeWorld(GetParam(), {});
  RenderContext context(Observation("fast"));
  Random random(5);
  constexpr int kGoals = 60;
  int unseen = 0, hidden = 0;
  for (int i = 0; i < kGoals; ++i) {
    world->Reset(&random);
    int seen = 0;
    for (const char* camera : {"front", "side"}) {
      int count = 0;
      RedCentre(Render(&context, world.get(), camera), &count);
      seen += count >= 3;
    }
    unseen += seen == 0;
    hidden += 2 - seen;
  }
  EXPECT_LE(unseen, kGoals / 20);
  EXPECT_LE(hidden, 2 * kGoals / 4);
}

INSTANTIATE_TEST_SUITE_P(Fetch, DefaultCameras,
                         testing::Values("FetchReach", "FetchPush", "FetchSlide",
                                         "FetchPickAndPlace"));

TEST(RenderContext, TheSkyIsGreenTheTableWhiteAndTheTopRowIsTheTop) {
  FetchReach world;
  world.ResetTo({1.47, 0.88, 0.6});
  RenderContext context(Observation("fast"));
  const Frame frame = Render(&context, &world, "gymnasium");
  const auto colour = [&](int row, int column) {
    const size_t at = static_cast<size_t>(row) * kSide + column;
    return std::array<int, 3>{frame[at], frame[kPlane + at], frame[2 * kPlane + at]};
  };
  for (const int column : {0, 83}) {
    EXPECT_NEAR(colour(0, column)[0], 115, 6);
    EXPECT_NEAR(colour(0, column)[1], 219, 6);
    EXPECT_NEAR(colour(0, column)[2], 145, 6);
  }
  const Pixel table = Project(FindCamera(world, "gymnasium"), {1.45, 0.5, 0.4});
  const Pixel floor = Project(FindCamera(world, "gymnasium"), {1.6, 0.2, 0});
  EXPECT_EQ(colour(static_cast<int>(table.y), static_cast<int>(table.x)),
            (std::array<int, 3>{255, 255, 255}));
  EXPECT_NEAR(colour(static_cast<int>(floor.y), static_cast<int>(floor.x))[0], 61, 4);
}

TEST(RenderContext, GreyIsOneChannelOfTheSamePicture) {
  FetchReach world;
  world.ResetTo({1.4, 0.7, 0.5});
  RenderContext colour(Observation("fast")), grey(Observation("fast", /*grey=*/true));
  const Frame rgb = Render(&colour, &world, "front"), luma = Render(&grey, &world, "front");
  ASSERT_EQ(luma.size(), kPlane);
  for (size_t i = 0; i < kPlane; ++i) {
    const double expected = 0.299 * rgb[i] + 0.587 * rgb[kPlane + i] + 0.114 * rgb[2 * kPlane + i];
    ASSERT_NEAR(luma[i], expected, 1.0) << i;
  }
}

TEST(RenderContext, CamerasOfOneFrameFollowEachOther) {
  FetchReach world;
  world.ResetTo({1.4, 0.7, 0.5});
  RenderContext context(Observation("fast"));
  const Frame front = Render(&context, &world, "front"), side = Render(&context, &world, "side");
  const std::vector<CameraView> cameras{FindCamera(world, "front"), FindCamera(world, "side")};
  Frame both(6 * kPlane);
  context.Render(&world, cameras, both);
  EXPECT_TRUE(std::equal(front.begin(), front.end(), both.begin()));
  EXPECT_TRUE(std::equal(side.begin(), side.end(), both.begin() + 3 * kPlane));
  EXPECT_GT(MeanAbsoluteError(front, side), 10);
}

TEST(RenderContext, TwoContextsDrawTheSameBytes) {
  FetchReach world;
  world.ResetTo({1.4, 0.7, 0.5});
  RenderContext first(Observation("fast")), second(Observation("fast"));
  const Frame once = Render(&first, &world, "close");
  EXPECT_EQ(Render(&second, &world, "close"), once);
}

TEST(RenderContext, AContextDrawsIntoItsOwnBufferWhicheverWasUsedLast) {
  FetchReach world;
  world.ResetTo({1.4, 0.7, 0.5});
  RenderContext fast(Observation("fast")), reference(Observation("reference"));
  const Frame once = Render(&fast, &world, "close");
  const Frame smooth = Render(&reference, &world, "close");
  EXPECT_NE(smooth, once);
  EXPECT_EQ(Render(&fast, &world, "close"), once);
  EXPECT_EQ(Render(&reference, &world, "close"), smooth);
}

// Contours differ: fast draws few triangles.
TEST(RenderContext, NativeFramesLookLikeFastOnes) {
  for (const char* task : {"FetchReach", "cartpole_swingup"}) {
    const auto world = MakeWorld(task, {}), other = MakeWorld(task, {});
    Random random(1), same(1);
    world->Reset(&random);
    other->Reset(&same);
    RenderContext fast(Observation("fast")), native(Observation("native"));
    const std::string camera = DefaultCamera(*world).name;
    EXPECT_LT(
        MeanAbsoluteError(Render(&fast, world.get(), camera), Render(&native, other.get(), camera)),
        6)
        << task;
  }
}

TEST(RenderContext, NativeGreyIsOneChannelOfTheSamePicture) {
  const auto world = MakeWorld("FetchReach", {});
  Random random(1);
  world->Reset(&random);
  RenderContext colour(Observation("native")), grey(Observation("native", /*grey=*/true));
  const Frame rgb = Render(&colour, world.get(), "front");
  const Frame luma = Render(&grey, world.get(), "front");
  ASSERT_EQ(luma.size(), kPlane);
  for (size_t i = 0; i < kPlane; ++i) {
    const double exact = 0.299 * rgb[i] + 0.587 * rgb[kPlane + i] + 0.114 * rgb[2 * kPlane + i];
    ASSERT_NEAR(luma[i], exact, 1.5) << i;
  }
}

TEST(RenderContext, WorldsThatShareAContextAreDrawnEachAsItIs) {
  FetchReach left, right;
  left.ResetTo({1.45, 0.65, 0.5});
  right.ResetTo({1.25, 0.85, 0.5});
  RenderContext context(Observation("fast")), other(Observation("fast"));
  const Frame left_alone = Render(&other, &left, "front");
  const Frame left_frame = Render(&context, &left, "front");
  const Frame right_frame = Render(&context, &right, "front");
  EXPECT_EQ(left_frame, left_alone);
  EXPECT_NE(left_frame, right_frame);
  EXPECT_EQ(Render(&context, &left, "front"), left_alone);
}

TEST(RenderContext, DrawingDoesNotChangeThePhysics) {
  FetchReach drawn, blind;
  drawn.ResetTo({1.4, 0.7, 0.5});
  blind.ResetTo({1.4, 0.7, 0.5});
  RenderContext context(Observation("fast"));
  for (int i = 0; i < 10; ++i) {
    Render(&context, &drawn, "side");
    drawn.Step(std::array<double, 4>{0.3, -0.2, 0.4, 0});
    blind.Step(std::array<double, 4>{0.3, -0.2, 0.4, 0});
  }
  EXPECT_EQ(drawn.arm().GripPosition(), blind.arm().GripPosition());
  EXPECT_EQ(drawn.arm().GripVelocity(), blind.arm().GripVelocity());
}

TEST(RenderContext, RefusesAWorldWithAnotherModel) {
  FetchReach ours;
  FetchReach other({.model = SourcePath("tests/actor/worlds/other_reach.xml")});
  RenderContext context(Observation("fast"));
  context.Attach(&ours);
  EXPECT_THROW(context.Attach(&other), Error);
}

TEST(RenderContext, RefusesAnUnknownQuality) {
  EXPECT_THROW(RenderContext context(Observation("beautiful")), Error);
}

TEST(RenderContext, KeepsTheRasterisersThreadsOut) {
  setenv("LP_NUM_THREADS", "4", 1);
  const RenderContext context(Observation("fast"));
  EXPECT_STREQ(getenv("LP_NUM_THREADS"), "0");
}

}  // namespace
}  // namespace shoal::worlds
