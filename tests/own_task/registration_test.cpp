// SPDX-License-Identifier: Apache-2.0
// The worked example of docs/own_task.md, registered in addition to the built-in tasks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>

#include "actor/evaluation/random_baseline.h"
#include "actor/worlds/environment.h"
#include "actor/worlds/physics_library.h"
#include "actor/worlds/world_registry.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/tasks/task_library.h"
#include "common/tasks/task_registry.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal::worlds {
namespace {

using testing::HasSubstr;

std::string Library() { return ProgramPath("point_reach.so"); }

// Repeated calls are allowed: a library is loaded once.
const tasks::Task& Example() {
  LoadTasks(Library());
  return tasks::FindTask("PointReachDense");
}

std::string Complaint(const std::function<void()>& what) {
  try {
    what();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    return error.what();
  }
  return "";
}

std::unique_ptr<World> NoWorld(const WorldOptions&) { return nullptr; }

TEST(OwnTask, IsFoundBesideTheBuiltInOnesWhichStayWhereTheyWere) {
  const tasks::Task& reach = tasks::FindTask("FetchReach");
  const tasks::Task& example = Example();
  EXPECT_EQ(example.world(), "PointReach");
  EXPECT_EQ(&tasks::FindTask("FetchReach"), &reach);
  // Behind the built-in ones, in the order in which libraries were loaded.
  const std::vector<std::string> names = tasks::TaskNames();
  EXPECT_GT(std::ranges::find(names, "PointReachDense"), std::ranges::find(names, "FetchReach"));
  EXPECT_EQ(std::ranges::count(names, "PointReachDense"), 1);
}

TEST(OwnTask, IsSteppedRenderedAndJudged) {
  Config config;
  config.task = Example().name();
  config.observation.cameras = {"top"};
  config.observation.height = config.observation.width = 32;
  config.observation.proprioception = true;
  config.observation.goal_mode = "desired";
  const auto environment = MakeEnvironment(config, MakeRenderContext(config.observation));
  std::vector<uint8_t> frame(static_cast<size_t>(environment->spec().FrameBytes()));
  std::vector<float> numbers(static_cast<size_t>(environment->spec().RecordedVectorSize()));
  ASSERT_EQ(numbers.size(), 8u);  // position, velocity, achieved goal, desired goal
  environment->Reset(1, {frame, numbers});
  const std::vector<uint8_t> before = frame;
  // Towards the goal along x at full force: it comes nearer, and the picture shows it.
  const float goal = numbers[6], start = numbers[0];
  StepResult result;
  for (int i = 0; i < 5; ++i) {
    result = environment->Step(std::vector<float>{goal > 0 ? 1.f : -1.f, 0}, {frame, numbers});
  }
  EXPECT_GT((numbers[0] - start) * goal, 0);
  EXPECT_FLOAT_EQ(result.reward, -result.distance);
  EXPECT_NE(frame, before);
}

TEST(OwnTask, ImageGoalsAreRefusedWhereTheWorldCannotShowThem) {
  Config config;
  config.task = Example().name();
  config.observation.cameras = {"top"};
  config.observation.goal_mode = "image";
  const auto render = MakeRenderContext(config.observation);
  try {
    MakeEnvironment(config, render);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_NE(std::string(error.what()).find("cannot show its goal reached"), std::string::npos)
        << error.what();
  }
}

// The point starts in the middle of every episode, so the target alone tells the pictures apart.
TEST(OwnTask, TheTargetIsDrawnWhereTheGoalIs) {
  Config config;
  config.task = Example().name();
  config.observation.cameras = {"top"};
  config.observation.goal_mode = "desired";
  const auto environment = MakeEnvironment(config, MakeRenderContext(config.observation));
  const int height = config.observation.height, width = config.observation.width;
  std::vector<uint8_t> frame(static_cast<size_t>(environment->spec().FrameBytes()));
  std::vector<float> recorded(static_cast<size_t>(environment->spec().RecordedVectorSize()));
  ASSERT_EQ(environment->spec().blocks.back().name, "desired_goal");
  const std::span<const float> goal = std::span(recorded).last(2);
  for (const uint64_t key : {1, 2, 3}) {
    environment->Reset(key, {frame, recorded});
    // Mean column and row of what is red: +x is to the right in the picture, +y up.
    double red = 0, column = 0, row = 0;
    const auto plane = static_cast<size_t>(height) * static_cast<size_t>(width);
    for (size_t i = 0; i < plane; ++i) {
      if (frame[i] < 100 || frame[plane + i] > 60 || frame[2 * plane + i] > 60) continue;
      ++red;
      column += static_cast<double>(i % static_cast<size_t>(width));
      row += static_cast<double>(i / static_cast<size_t>(width));
    }
    ASSERT_GT(red, 0) << "episode " << key;
    EXPECT_GT((column / red - width / 2.0) * double{goal[0]}, 0) << "episode " << key;
    EXPECT_LT((row / red - height / 2.0) * double{goal[1]}, 0) << "episode " << key;
  }
}

TEST(OwnTask, WorksInTheTools) {
  const auto baseline =
      actor::PlayRandom({.task = Example().name(), .episodes = 3}, [] { return false; });
  EXPECT_NEAR(baseline.at("aggregate").at("length_mean").get<double>(), 40, 1e-9);
}

// The section of the page on MJCF files with meshes: docs/examples/arm_reach.
TEST(OwnTask, AModelWithMeshesLiesBesideItsLibraryWhereverTheProgramStands) {
  LoadTasks(ProgramPath("arm_reach.so"));
  Config config;
  config.task = "ArmReachDense";
  config.observation.height = config.observation.width = 48;
  const std::filesystem::path here = std::filesystem::current_path();
  std::filesystem::current_path("/");
  const auto environment = MakeEnvironment(config, MakeRenderContext(config.observation));
  std::filesystem::current_path(here);
  EXPECT_EQ(environment->spec().cameras, std::vector<std::string>{"overhead"})
      << "the first camera of the model stands in for front and side";
  std::vector<uint8_t> frame(static_cast<size_t>(environment->spec().FrameBytes()));
  std::vector<float> numbers(static_cast<size_t>(environment->spec().RecordedVectorSize()));
  environment->Reset(1, {frame, numbers});
  const std::vector<uint8_t> before = frame;
  for (int i = 0; i < 10; ++i) environment->Step(std::vector<float>{1, 0}, {frame, numbers});
  EXPECT_GT(numbers[0], 0.1) << "the shoulder turns";
  // The blue part, the upper link, has moved.
  const size_t plane = 48 * 48;
  const auto blue = [&](const std::vector<uint8_t>& picture) {
    std::vector<size_t> pixels;
    for (size_t i = 0; i < plane; ++i) {
      if (picture[2 * plane + i] > picture[i] + 60) pixels.push_back(i);
    }
    return pixels;
  };
  EXPECT_GT(blue(before).size(), 10u);
  EXPECT_NE(blue(before), blue(frame));
}

TEST(OwnTask, AModelFileThatIsMissingIsNamedWithItsWholePath) {
  LoadTasks(ProgramPath("arm_reach.so"));
  EXPECT_THAT(Complaint([] { MakeWorld("ArmReach", {.model = "/nowhere/arm.xml"}); }),
              HasSubstr("model file '/nowhere/arm.xml' does not exist"));
}

TEST(OwnTask, TakesNoNameThatIsTaken) {
  const tasks::Task& example = Example();
  EXPECT_THAT(Complaint([] { AddWorld("PointReach", NoWorld); }), HasSubstr("'PointReach'"));
  EXPECT_THAT(Complaint([] { AddWorld("FetchReach", NoWorld); }), HasSubstr("'FetchReach'"));
  const size_t before = tasks::TaskNames().size();
  EXPECT_THROW(tasks::AddTask(example), Error);
  EXPECT_EQ(tasks::TaskNames().size(), before);
}

TEST(OwnTask, ALibraryThatIsNoneIsRefusedInOneLine) {
  const TemporaryFolder folder;
  const std::string missing = (folder.path() / "missing.so").string();
  EXPECT_THAT(Complaint([&] { LoadTasks(missing); }), HasSubstr("cannot load " + missing));
  const std::string text = (folder.path() / "text.so").string();
  WriteFileAtomically(text, "not a library");
  EXPECT_THAT(Complaint([&] { LoadTasks(text); }), HasSubstr("cannot load " + text));
  // The physics half has no goals.
  const std::string physics = ProgramPath("point_reach_physics.so");
  const std::string lonely = (folder.path() / "lonely.so").string();
  std::filesystem::copy_file(physics, lonely);
  EXPECT_THAT(Complaint([&] { LoadTasks(lonely); }),
              HasSubstr("'" + lonely + "' has no entry point ShoalRegisterGoals"));
  EXPECT_EQ(Complaint([&] { LoadTasks(""); }), "");
}

TEST(OwnTask, AnotherLibraryMayNotTakeItsNameNorATaskNameAWorldThatIsNotThere) {
  const TemporaryFolder folder;
  const std::string lonely = (folder.path() / "lonely.so").string();
  std::filesystem::copy_file(Library(), lonely);
  Example();
  EXPECT_THAT(Complaint([&] { LoadTasks(lonely); }), HasSubstr("a task 'PointReachDense' already"));
  EXPECT_THAT(Complaint([] { MakeWorld("Nowhere", {}); }), HasSubstr("no physics half 'Nowhere'"));
}

}  // namespace
}  // namespace shoal::worlds
