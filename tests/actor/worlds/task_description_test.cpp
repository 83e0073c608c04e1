// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/task_description.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "actor/worlds/tools/task_table.h"
#include "common/base/error.h"
#include "common/tasks/task_registry.h"

namespace shoal::worlds {
namespace {

using testing::HasSubstr;

TaskDescription Reach() {
  return DescribeTask({.task = "FetchReachDense",
                       .model = "",
                       .probe_env_steps = 3,
                       .random_env_steps = 60,
                       .seed = 1});
}

TEST(TaskDescription, EachAxisAloneMovesItsOwnCoordinateAndNoOther) {
  const TaskDescription reach = Reach();
  ASSERT_EQ(reach.probes.size(), 8u);
  for (const AxisProbe& probe : reach.probes) {
    EXPECT_EQ(probe.env_steps, 3);
    ASSERT_EQ(probe.change.size(), 10u);
    for (int coordinate = 0; coordinate < 3; ++coordinate) {
      const double change = probe.change[static_cast<size_t>(coordinate)];
      if (coordinate == probe.axis) {
        // About 3 cm a step: the arm lags behind the 5 cm that it is pulled by.
        EXPECT_GT(change * probe.command, 0.06) << probe.axis;
        EXPECT_LT(change * probe.command, 0.15) << probe.axis;
      } else {
        EXPECT_LT(std::fabs(change), 0.01) << probe.axis << " moved " << coordinate;
      }
    }
  }
}

TEST(TaskDescription, ABlockedGripperChangesNothing) {
  const TaskDescription reach = Reach();
  for (const AxisProbe& probe : reach.probes) {
    if (probe.axis != 3) continue;
    for (const double change : probe.change) EXPECT_EQ(change, 0);
  }
}

TEST(TaskDescription, MeasuredRangesLieWhereTheTaskPlays) {
  const TaskDescription reach = Reach();
  ASSERT_EQ(reach.observation.size(), 10u);
  ASSERT_EQ(reach.desired_goal.size(), 3u);
  const double centre[] = {1.34, 0.75, 0.535};
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_LT(reach.observation[i].low, reach.observation[i].high);
    EXPECT_EQ(reach.observation[i].low, reach.achieved_goal[i].low) << "the grip is achieved";
    EXPECT_GE(reach.desired_goal[i].low, centre[i] - 0.151);
    EXPECT_LE(reach.desired_goal[i].high, centre[i] + 0.152);
    EXPECT_LT(reach.desired_goal[i].low, reach.desired_goal[i].high) << "two episodes, two goals";
  }
  EXPECT_NEAR(reach.env_step_seconds, 0.04, 1e-9);
}

TEST(TaskDescription, EveryTaskIsDescribedWithAllItsNumbers) {
  for (const std::string& name : tasks::TaskNames()) {
    DescribeRequest request;
    request.task = name;
    request.probe_env_steps = 1;
    request.random_env_steps = 20;
    const TaskDescription description = DescribeTask(request);
    const nlohmann::ordered_json json = ToJson(description);
    const tasks::Task& task = tasks::FindTask(name);
    EXPECT_EQ(json.at("task"), name);
    EXPECT_EQ(json.at("action").size(), static_cast<size_t>(task.action_size()));
    EXPECT_EQ(json.at("blocks")[0].at("components").size(),
              static_cast<size_t>(task.observation().size()));
    EXPECT_EQ(json.at("blocks").size(), task.goal_size() > 0 ? 3u : 1u);
    EXPECT_EQ(json.at("reward").at("threshold").is_null(), task.goal_size() == 0);
    EXPECT_EQ(json.at("probes").size(), 2u * static_cast<size_t>(task.action_size()));
    EXPECT_GT(json.at("env_step_seconds"), 0);
    EXPECT_FALSE(json.at("cameras").empty());
    const std::string text = ToText(description);
    for (const tasks::Component& number : task.observation().components) {
      EXPECT_THAT(text, HasSubstr(number.name));
      EXPECT_THAT(text, HasSubstr(number.meaning));
    }
  }
}

TEST(TaskDescription, InfiniteBoundsAreNullAndActionsHaveTheirs) {
  const nlohmann::ordered_json json = ToJson(Reach());
  EXPECT_TRUE(json.at("blocks")[0].at("components")[0].at("low").is_null());
  EXPECT_EQ(json.at("action")[0].at("low"), -1);
  EXPECT_EQ(json.at("action")[0].at("high"), 1);
}

TEST(TaskDescription, AnUnknownTaskIsRefusedListingThoseThereAre) {
  try {
    DescribeTask({.task = "FetchSleep"});
    FAIL() << "described a task that is not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_THAT(error.what(), HasSubstr("FetchReachDense"));
  }
}

TEST(TaskTable, HasOneLineForEveryTask) {
  const std::string table = TaskTable();
  const nlohmann::ordered_json rows = TaskTableJson().at("tasks");
  ASSERT_EQ(rows.size(), tasks::TaskNames().size());
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'),
            static_cast<std::ptrdiff_t>(rows.size() + 1));
  for (const auto& row : rows) EXPECT_THAT(table, HasSubstr(row.at("task").get<std::string>()));
  EXPECT_EQ(rows[0].at("reward"), "sparse");
  EXPECT_EQ(rows[1].at("reward"), "dense");
}

}  // namespace
}  // namespace shoal::worlds
