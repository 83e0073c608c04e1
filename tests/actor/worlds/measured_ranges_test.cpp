// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/measured_ranges.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

namespace shoal::worlds {
namespace {

using testing::ElementsAre;

tasks::Task Made() {
  tasks::Task::Description task;
  task.name = "Made";
  task.episode_length = 10;
  task.observation = {{"position", {{"x"}, {"y"}}}};
  task.achieved_goal = {"achieved_goal", {{"x"}}};
  task.desired_goal = {"desired_goal", {{"x"}}};
  return tasks::Task(task);
}

std::vector<std::string> NamesOf(const std::vector<ConstantNumber>& constant) {
  std::vector<std::string> names;
  for (const ConstantNumber& number : constant) names.push_back(number.block + "." + number.name);
  return names;
}

TEST(RangeMeter, MeasuresEveryNumber) {
  RangeMeter meter(Made());
  meter.OnReset(std::array{1.f, 0.f, 5.f, 2.f});
  meter.OnStep(std::array{-1.f, 0.f, 6.f, 2.f});
  EXPECT_EQ(meter.ranges()[0].low, -1);
  EXPECT_EQ(meter.ranges()[0].high, 1);
  EXPECT_EQ(meter.ranges()[2].high, 6);
  EXPECT_EQ(meter.observations(), 2);
  EXPECT_EQ(meter.episodes(), 1);
}

TEST(ConstantNumbers, AreThoseThatNeverChanged) {
  const tasks::Task task = Made();
  RangeMeter meter(task);
  meter.OnReset(std::array{1.f, 0.f, 5.f, 2.f});
  EXPECT_TRUE(ConstantNumbers(task, meter).empty()) << "one observation says nothing";
  meter.OnStep(std::array{2.f, 0.f, 6.f, 2.f});
  EXPECT_THAT(NamesOf(ConstantNumbers(task, meter)), ElementsAre("position.y"))
      << "a desired goal stays within its episode";
  meter.OnReset(std::array{1.f, 0.f, 5.f, 2.f});
  EXPECT_THAT(NamesOf(ConstantNumbers(task, meter)), ElementsAre("position.y", "desired_goal.x"));
  meter.OnReset(std::array{1.f, 0.5f, 5.f, 3.f});
  EXPECT_TRUE(ConstantNumbers(task, meter).empty());
}

TEST(ConstantNumbers, AreNamedInALineEach) {
  EXPECT_EQ(ToText(std::vector<ConstantNumber>{{"position", "y", 0.5}}, 511),
            "  warning: y of block 'position' was 0.5 in all of 511 observations: does the physics "
            "half write its value?\n");
  EXPECT_EQ(ToText(std::vector<ConstantNumber>(), 511), "");
}

}  // namespace
}  // namespace shoal::worlds
