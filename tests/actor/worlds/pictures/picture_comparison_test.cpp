// SPDX-License-Identifier: Apache-2.0
// Few states of every task and camera; shoal-pictures compares more.
#include "tests/actor/worlds/pictures/picture_comparison.h"

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "actor/worlds/abstract_scene.h"
#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/native/renderer.h"
#include "tests/actor/worlds/native/scene_by_hand.h"

namespace shoal::worlds {
namespace {

constexpr int kStates = 8;
constexpr size_t kPixels = size_t{kPictureSide} * kPictureSide;

class Pictures : public testing::TestWithParam<std::string> {};

TEST_P(Pictures, LookLikeTheEnginesWithoutShadows) {
  for (const CameraComparison& c : ComparePictures(GetParam(), kStates)) {
    EXPECT_EQ(c.states, kStates);
    EXPECT_LE(c.mean_difference, 4) << c.camera;
    EXPECT_LE(c.most_difference, 12) << c.camera;
    EXPECT_GE(c.mean_overlap, 0.98) << c.camera;
    EXPECT_GE(c.moving_overlap, 0.98) << c.camera;
    for (const PartAgreement& part : TellingParts(c)) {
      if (!IsFingerOrMarker(part)) continue;
      EXPECT_EQ(part.missed, 0) << part.name << ", " << c.camera;
      EXPECT_GE(part.overlap(), 0.85) << part.name << ", " << c.camera;
    }
  }
}

TEST_P(Pictures, AreTheSameBitsOnAllInstructionSetsAndWithoutLayers) {
  RandomStates states(GetParam(), 11);
  World* world = states.world();
  std::vector<std::unique_ptr<native::Renderer>> renderers;
  for (const native::InstructionSet set : native::SupportedSets()) {
    renderers.push_back(std::make_unique<native::Renderer>(world->model(), set));
  }
  renderers.push_back(std::make_unique<native::Renderer>(world->model()));
  renderers.back()->KeepLayers(false);
  AbstractScene scene;
  scene.Allocate(*world);
  for (const CameraView& camera : CamerasOf(*world)) {
    for (int state = 0; state < kStates; ++state) {
      states.Next();
      scene.Update(world, camera);
      std::vector<uint8_t> first(3 * kPixels), other(3 * kPixels);
      renderers[0]->Draw(scene.scene(), kPictureSide, kPictureSide, first);
      for (size_t i = 1; i < renderers.size(); ++i) {
        renderers[i]->Draw(scene.scene(), kPictureSide, kPictureSide, other);
        ASSERT_EQ(first, other) << camera.name << ", state " << state << ", renderer " << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Tasks, Pictures, testing::ValuesIn(TasksOfAllWorlds()),
                         [](const auto& task) {
                           std::string name = task.param;
                           std::ranges::replace_if(
                               name, [](char c) { return !isalnum(c); }, '_');
                           return name;
                         });

TEST(PictureComparison, TellsFingersMarkersAndTheWorstPart) {
  CameraComparison comparison;
  comparison.parts = {{"geom a", 10, 0, 900, 900, 890},
                      {"geom b", 10, 0, 900, 900, 700},
                      {"geom speck", 10, 0, 20, 20, 1},
                      {"geom finger", 10, 0, 900, 900, 900},
                      {"site target0", 10, 2, 90, 90, 60}};
  std::vector<std::string> names;
  for (const PartAgreement& part : TellingParts(comparison)) names.push_back(part.name);
  EXPECT_EQ(names, (std::vector<std::string>{"geom finger", "site target0", "geom b"}));
  EXPECT_DOUBLE_EQ(comparison.parts[1].overlap(), 700.0 / 1100);
  const auto json = ToJson({comparison});
  EXPECT_EQ(json.at("cameras")[0].at("missed_parts"), 2);
  EXPECT_EQ(json.at("cameras")[0].at("parts")[1].at("missed"), 2);
}

TEST(PictureComparison, AStripShowsBothSides) {
  const PictureStrip strip = DrawStrip({"FetchReach", "walker_walk"});
  EXPECT_EQ(strip.width, 2 * kPictureSide + 4);
  EXPECT_EQ(strip.height, 2 * kPictureSide + 4);
  double difference = 0;
  const size_t row = 3 * size_t(strip.width), half = row * (kPictureSide + 4);
  for (size_t i = 0; i < row * kPictureSide; ++i) {
    difference += std::abs(int{strip.pixels[i]} - int{strip.pixels[half + i]});
  }
  EXPECT_LT(difference / double(row * kPictureSide), 4);
  EXPECT_GT(difference, 0) << "the same picture twice";
}

}  // namespace
}  // namespace shoal::worlds
