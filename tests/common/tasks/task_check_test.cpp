// SPDX-License-Identifier: Apache-2.0
#include "common/tasks/task_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "common/tasks/task_registry.h"
#include "tests/support/error_message.h"

namespace shoal::tasks {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Task::Description Good() {
  Task::Description task;
  task.name = "Good";
  task.world = "GoodWorld";
  task.episode_length = 10;
  task.action = {{"push"}};
  task.observation = {{"position", {{"x"}, {"y"}}}, {"velocity", {{"velocity_x"}}}};
  task.achieved_goal = {"achieved_goal", {{"x"}, {"y"}}};
  task.desired_goal = {"desired_goal", {{"x"}, {"y"}}};
  task.distance_threshold = 0.05;
  return task;
}

// The refusal of the good description after `spoil`; empty when it is taken.
std::string Refusal(const std::function<void(Task::Description&)>& spoil) {
  Task::Description task = Good();
  spoil(task);
  return UsageMessage([&] { const Task made(task); });
}

TEST(CheckDescription, TakesAGoodOneAndTheBuiltInOnes) {
  EXPECT_EQ(Refusal([](auto&) {}), "");
  EXPECT_EQ(Refusal([](auto& task) { task.achieved_goal = task.desired_goal = {}; }), "");
  for (const std::string& name : TaskNames()) EXPECT_NO_THROW(CheckPlayable(FindTask(name)));
}

TEST(CheckDescription, TwoBlocksOfOneNameAreNamed) {
  EXPECT_THAT(Refusal([](auto& task) { task.observation[1].name = "position"; }),
              AllOf(HasSubstr("'Good'"), HasSubstr("two blocks have the name 'position'")));
  EXPECT_THAT(Refusal([](auto& task) { task.observation[0].name = "desired_goal"; }),
              HasSubstr("two blocks have the name 'desired_goal'"));
  EXPECT_THAT(Refusal([](auto& task) { task.achieved_goal.name = "desired_goal"; }),
              HasSubstr("two blocks have the name 'desired_goal'"));
}

TEST(CheckDescription, ABlocksNameIsAnIdentifier) {
  for (const char* name : {"", "a b", "a/b", "../x", "object-grip", "1st", "a\nb", "\xc3\xa4"}) {
    const std::string refusal = Refusal([&](auto& task) { task.observation[0].name = name; });
    EXPECT_THAT(refusal, HasSubstr("no name of a block")) << name;
    EXPECT_THAT(refusal, Not(HasSubstr("\n")));
  }
  EXPECT_THAT(Refusal([](auto& task) { task.observation[0].name = std::string(65, 'a'); }),
              HasSubstr("no name of a block"));
}

TEST(CheckDescription, ATasksNameCanBeAFolders) {
  for (const char* name : {"", "a/b", "..", "-x", "a b"}) {
    EXPECT_THAT(Refusal([&](auto& task) { task.name = name; }), HasSubstr("no name of a task"));
  }
  EXPECT_EQ(Refusal([](auto& task) { task.name = "My-Task_v2.1"; }), "");
}

TEST(CheckDescription, SizesAreNeitherNoneNorHuge) {
  EXPECT_THAT(Refusal([](auto& task) { task.observation[0].components.clear(); }),
              HasSubstr("block 'position' has no numbers"));
  EXPECT_THAT(Refusal([](auto& task) { task.observation[0].components.resize(70'000, {"x"}); }),
              HasSubstr("the state vector has 70001 numbers; expected at most 65536"));
  EXPECT_THAT(Refusal([](auto& task) { task.action.resize(2'000, {"a"}); }),
              HasSubstr("the action has 2000 numbers"));
  EXPECT_THAT(Refusal([](auto& task) { task.achieved_goal.components.pop_back(); }),
              AllOf(HasSubstr("goals of different size"), HasSubstr("'achieved_goal' has 1"),
                    HasSubstr("'desired_goal' has 2")));
}

TEST(CheckDescription, BoundsAreOrderedNumbers) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& bounds : {std::pair{kNan, 1.0}, {0.0, kNan}, {1.0, 0.0}}) {
    EXPECT_THAT(Refusal([&](auto& task) {
                  task.observation[0].components[1].low = bounds.first;
                  task.observation[0].components[1].high = bounds.second;
                }),
                AllOf(HasSubstr("block 'position'"), HasSubstr("y has bounds")));
  }
  EXPECT_THAT(Refusal([&](auto& task) { task.action[0].low = kNan; }),
              HasSubstr("the action: push has bounds"));
  EXPECT_THAT(Refusal([&](auto& task) { task.distance_threshold = kNan; }),
              HasSubstr("distance_threshold is nan"));
  EXPECT_THAT(Refusal([](auto& task) { task.observation[0].components[0].name = ""; }),
              HasSubstr("a number of block 'position' has no name"));
}

TEST(CheckDescription, LengthAndRepeatArePositive) {
  EXPECT_THAT(Refusal([](auto& task) { task.episode_length = 0; }),
              HasSubstr("episode_length is 0"));
  EXPECT_THAT(Refusal([](auto& task) { task.action_repeat = 0; }), HasSubstr("action_repeat is 0"));
  EXPECT_THAT(Refusal([](auto& task) { task.action_repeat = 11; }),
              HasSubstr("expected 1 to the episode_length of 10"));
}

TEST(CheckPlayable, ATaskThatIsAddedHasAnActionAndAPhysicsHalf) {
  Task::Description idle = Good();
  idle.action.clear();
  EXPECT_THAT(UsageMessage([&] { AddTask(Task(idle)); }), HasSubstr("the action has no numbers"));
  Task::Description lost = Good();
  lost.world.clear();
  EXPECT_THAT(UsageMessage([&] { AddTask(Task(lost)); }), HasSubstr("names no physics half"));
}

}  // namespace
}  // namespace shoal::tasks
