// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/custom_cameras.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "actor/worlds/environment.h"
#include "actor/worlds/world_registry.h"
#include "common/base/error.h"

namespace shoal::worlds {
namespace {

using testing::HasSubstr;

ObservationConfig WithTop(double elevation = -80) {
  ObservationConfig observation;
  observation.width = observation.height = 24;
  observation.cameras = {"top"};
  observation.custom_cameras["top"] = {{1.34, 0.75, 0.5}, 1.2, 180, elevation};
  return observation;
}

std::string Complaint(const ObservationConfig& observation, const std::string& name) {
  try {
    ChooseCamera(*MakeWorld("FetchReach", {}), observation, name);
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    return error.what();
  }
  return "";
}

TEST(CustomCameras, StandBesideTheTasksOwn) {
  const auto world = MakeWorld("FetchReach", {});
  const CameraView top = ChooseCamera(*world, WithTop(), "top");
  EXPECT_EQ(top.name, "top");
  EXPECT_EQ(top.distance, 1.2);
  EXPECT_EQ(top.azimuth_degrees, 180);
  EXPECT_EQ(top.elevation_degrees, -80);
  EXPECT_EQ(ChooseCamera(*world, WithTop(), "front").name, "front");
}

TEST(CustomCameras, AnUnknownNameListsBothKinds) {
  EXPECT_THAT(Complaint(WithTop(), "moon"),
              testing::AllOf(HasSubstr("moon"), HasSubstr("front"), HasSubstr("top")));
}

TEST(CustomCameras, MayNotHideACameraOfTheTask) {
  ObservationConfig observation = WithTop();
  observation.custom_cameras["front"] = observation.custom_cameras["top"];
  EXPECT_THAT(Complaint(observation, "front"), HasSubstr("'front' is a camera of the task"));
}

TEST(CustomCameras, DrawWhatTheySeeAndMarkTheSpec) {
  const auto look = [](const ObservationConfig& observation, std::vector<uint8_t>* frame) {
    Config config;
    config.observation = observation;
    const auto environment = MakeEnvironment(config, MakeRenderContext(observation));
    frame->resize(static_cast<size_t>(environment->spec().FrameBytes()));
    std::vector<float> unread(static_cast<size_t>(environment->spec().RecordedVectorSize()));
    environment->Reset(1, {*frame, unread});
    return environment->spec();
  };
  std::vector<uint8_t> above, aside;
  const ObservationSpec steep = look(WithTop(-80), &above), flat = look(WithTop(-10), &aside);
  EXPECT_NE(above, aside);
  EXPECT_EQ(steep.cameras, std::vector<std::string>{"top"});
  EXPECT_NE(steep.Hash(), flat.Hash()) << "another view is another observation";
}

TEST(DistanceThreshold, OfTheConfigurationReplacesTheTasksOwn) {
  const auto successes = [](double threshold, float* reward) {
    Config config;
    config.task = "FetchReach";
    config.distance_threshold = threshold;
    config.observation.pixels = false;
    const auto environment = MakeEnvironment(config, nullptr);
    std::vector<float> numbers(static_cast<size_t>(environment->spec().RecordedVectorSize()));
    const float distance = environment->Reset(1, {{}, numbers});
    EXPECT_GT(distance, 0.06);
    const StepResult result = environment->Step(std::vector<float>(4), {{}, numbers});
    *reward = result.reward;
    return result.success;
  };
  float reward = 0;
  EXPECT_FALSE(successes(0, &reward));
  EXPECT_EQ(reward, -1);
  EXPECT_TRUE(successes(2, &reward));
  EXPECT_EQ(reward, 0);
}

}  // namespace
}  // namespace shoal::worlds
