// The worked example of docs/own_task.md beside the built-in tasks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "actor/random_baseline.h"
#include "actor/worlds/environment.h"
#include "actor/worlds/own_tasks.h"
#include "actor/worlds/world_registry.h"
#include "common/base/error.h"
#include "common/tasks/task_registry.h"

namespace shoal::worlds {
namespace {

using testing::HasSubstr;

// Once in this process, as programs do.
const tasks::Task& Example() {
  static const bool registered = (RegisterOwnTasks(), true);
  EXPECT_TRUE(registered);
  return tasks::FindTask("PointReachDense");
}

std::string Complaint(tasks::Task task, WorldMaker maker) {
  try {
    RegisterTask(std::move(task), maker);
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
  EXPECT_EQ(tasks::TaskNames().back(), "PointReachDense");
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
  std::vector<float> numbers(static_cast<size_t>(environment->spec().VectorSize()));
  ASSERT_EQ(numbers.size(), 6u);
  environment->Reset(1, {frame, numbers});
  const std::vector<uint8_t> before = frame;
  // Towards the goal along x at full force: it comes nearer, and the picture shows it.
  const float goal = numbers[4], start = numbers[0];
  StepResult result;
  for (int i = 0; i < 5; ++i) {
    result = environment->Step(std::vector<float>{goal > 0 ? 1.f : -1.f, 0}, {frame, numbers});
  }
  EXPECT_GT((numbers[0] - start) * goal, 0);
  EXPECT_FLOAT_EQ(result.reward, -result.distance);
  EXPECT_NE(frame, before);
}

TEST(OwnTask, WorksInTheTools) {
  const auto baseline =
      actor::PlayRandom({.task = Example().name(), .episodes = 3}, [] { return false; });
  EXPECT_NEAR(baseline.at("aggregate").at("length_mean").get<double>(), 40, 1e-9);
}

TEST(OwnTask, TakesNoNameThatIsTaken) {
  const tasks::Task& example = Example();
  EXPECT_THAT(Complaint(example, NoWorld), HasSubstr("PointReach"));
  EXPECT_THAT(Complaint(tasks::FindTask("FetchReach"), NoWorld), HasSubstr("FetchReach"));
  const size_t before = tasks::TaskNames().size();
  EXPECT_THROW(tasks::AddTask(example), Error);
  EXPECT_EQ(tasks::TaskNames().size(), before);
}

}  // namespace
}  // namespace shoal::worlds
