// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/observed_numbers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "actor/worlds/model_text.h"
#include "tests/support/error_message.h"

namespace shoal::worlds {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr char kModel[] = R"(<mujoco><worldbody><geom size="1"/></worldbody></mujoco>)";

tasks::Task TaskOf(bool goals) {
  tasks::Task::Description task;
  task.name = "Sized";
  task.episode_length = 10;
  task.observation = {{"position", {{"x"}, {"y"}}}, {"velocity", {{"velocity_x"}, {"velocity_y"}}}};
  if (goals) {
    task.achieved_goal = {"achieved_goal", {{"x"}}};
    task.desired_goal = {"desired_goal", {{"x"}}};
  }
  return tasks::Task(task);
}

// Writes that many numbers to each part, from the beginning, whatever their sizes are: 1, 2, ... to
// the state, 101, ... and 201, ... to the goals.
class Writer final : public World {
 public:
  Writer(int state, int achieved, int desired)
      : World(LoadModelText(kModel, "")), counts_{state, achieved, desired} {}

  void Reset(Random*) override {}
  Outcome Step(std::span<const double>) override { return {}; }
  void Observe(std::span<double> state, std::span<double> achieved,
               std::span<double> desired) const override {
    const std::array parts{state.data(), achieved.data(), desired.data()};
    for (size_t part = 0; part < parts.size(); ++part) {
      for (int i = 0; i < counts_[part]; ++i) {
        parts[part][i] = value + 100 * static_cast<double>(part) + i;
      }
    }
    if (before) state.data()[-1] = 1;
  }
  std::span<const CameraView> cameras() const override { return {}; }

  double value = 1;
  bool before = false;

 private:
  const std::array<int, 3> counts_;
};

std::string Refusal(int state, int achieved, int desired, bool goals = true) {
  const tasks::Task task = TaskOf(goals);
  ObservedNumbers numbers(task);
  return UsageMessage([&] { numbers.Read(Writer(state, achieved, desired)); });
}

TEST(ObservedNumbers, HasWhatTheWorldWrote) {
  const tasks::Task task = TaskOf(true);
  ObservedNumbers numbers(task);
  numbers.Read(Writer(4, 1, 1));
  EXPECT_THAT(numbers.state(), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(numbers.achieved_goal(), ElementsAre(101));
  EXPECT_THAT(numbers.desired_goal(), ElementsAre(201));
}

TEST(ObservedNumbers, ANumberTooManyNamesTaskBlockAndSizes) {
  EXPECT_EQ(
      Refusal(5, 1, 1),
      "task Sized: block 'velocity' has 2 numbers in the goal half, Observe wrote 3 (5 in all; "
      "the goal half says position (2), velocity (2) = 4)");
  EXPECT_THAT(Refusal(4, 3, 1), HasSubstr("block 'achieved_goal' has 1 numbers in the goal half, "
                                          "Observe wrote 3"));
  EXPECT_THAT(Refusal(4, 1, 2), HasSubstr("block 'desired_goal' has 1 numbers"));
  EXPECT_THAT(Refusal(4 + static_cast<int>(ObservedNumbers::kGuard), 1, 1),
              HasSubstr("Observe wrote at least 66"));
}

TEST(ObservedNumbers, ANumberTooFewNamesTheFirstThatIsMissing) {
  EXPECT_EQ(
      Refusal(3, 1, 1),
      "task Sized: block 'velocity' has 2 numbers in the goal half, Observe wrote 1: velocity_y "
      "was never written (the goal half says position (2), velocity (2) = 4)");
  EXPECT_THAT(Refusal(0, 1, 1),
              HasSubstr("block 'position' has 2 numbers in the goal half, Observe "
                        "wrote 0: x was never written"));
  EXPECT_THAT(Refusal(4, 1, 0), HasSubstr("block 'desired_goal' has 1 numbers in the goal half, "
                                          "Observe wrote 0"));
}

TEST(ObservedNumbers, AGoalThatTheTaskDoesNotHaveIsNoticed) {
  EXPECT_EQ(Refusal(4, 0, 0, /*goals=*/false), "");
  EXPECT_THAT(Refusal(4, 3, 0, /*goals=*/false),
              HasSubstr("Observe wrote 3 numbers of a goal, of which the goal half has none"));
}

TEST(ObservedNumbers, WhatIsWrittenBeforeTheBeginningIsNoticed) {
  const tasks::Task task = TaskOf(true);
  ObservedNumbers numbers(task);
  Writer writer(4, 1, 1);
  writer.before = true;
  EXPECT_THAT(UsageMessage([&] { numbers.Read(writer); }), HasSubstr("before the beginning"));
}

// A sensor's NaN is a fault of an episode, no wrong size.
TEST(ObservedNumbers, ANumberThatIsNotFiniteIsOneThatWasWritten) {
  const tasks::Task task = TaskOf(true);
  ObservedNumbers numbers(task);
  Writer writer(4, 1, 1);
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::signaling_NaN(),
        std::numeric_limits<double>::infinity()}) {
    writer.value = value;
    EXPECT_NO_THROW(numbers.Read(writer));
  }
}

TEST(ObservedNumbers, EachReadIsCheckedAnew) {
  const tasks::Task task = TaskOf(true);
  ObservedNumbers numbers(task);
  numbers.Read(Writer(4, 1, 1));
  EXPECT_THAT(UsageMessage([&] { numbers.Read(Writer(3, 1, 1)); }),
              HasSubstr("velocity_y was never written"))
      << "the number of the time before does not count";
  EXPECT_NO_THROW(numbers.Read(Writer(4, 1, 1)));
}

}  // namespace
}  // namespace shoal::worlds
