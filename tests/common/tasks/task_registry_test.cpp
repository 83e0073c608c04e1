#include "common/tasks/task_registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "common/base/error.h"

namespace shoal::tasks {
namespace {

using testing::HasSubstr;

TEST(TaskRegistry, NamesAreUniqueAndFindTheirTask) {
  std::set<std::string> seen;
  for (const std::string& name : TaskNames()) {
    EXPECT_TRUE(seen.insert(name).second) << name;
    EXPECT_EQ(FindTask(name).name(), name);
  }
  EXPECT_TRUE(seen.contains("FetchReach") && seen.contains("FetchPickAndPlaceDense"));
}

TEST(TaskRegistry, EveryNumberSaysWhatItMeansAndActionsAreBounded) {
  for (const std::string& name : TaskNames()) {
    const Task& task = FindTask(name);
    for (const Component& axis : task.action()) {
      EXPECT_NE(axis.meaning, "") << name << " action " << axis.name;
      EXPECT_EQ(axis.low, -1) << name << " action " << axis.name;
      EXPECT_EQ(axis.high, 1) << name << " action " << axis.name;
    }
    for (const Block* block : {&task.observation(), &task.achieved_goal(), &task.desired_goal()}) {
      for (const Component& number : block->components) {
        EXPECT_NE(number.meaning, "") << name << " " << block->name << " " << number.name;
        EXPECT_LT(number.low, number.high) << name << " " << block->name << " " << number.name;
      }
    }
  }
}

TEST(TaskRegistry, AnUnknownTaskIsAUsageErrorThatListsTheTasks) {
  try {
    FindTask("FetchReech");
    FAIL() << "found a task that is not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_THAT(error.what(), HasSubstr("FetchReech"));
    EXPECT_THAT(error.what(), HasSubstr("FetchReach, FetchReachDense"));
  }
}

TEST(TaskRegistry, FetchReachIsDescribedAsPublished) {
  for (const char* name : {"FetchReach", "FetchReachDense"}) {
    const Task& task = FindTask(name);
    EXPECT_EQ(task.world(), "FetchReach");
    EXPECT_EQ(task.episode_length(), 50);
    EXPECT_EQ(task.action_size(), 4);
    EXPECT_EQ(task.observation().size(), 10);
    EXPECT_EQ(task.goal_size(), 3);
    EXPECT_EQ(task.distance_threshold(), 0.05);
  }
  EXPECT_EQ(FindTask("FetchReach").reward_kind(), RewardKind::kSparse);
  EXPECT_EQ(FindTask("FetchReachDense").reward_kind(), RewardKind::kDense);
}

}  // namespace
}  // namespace shoal::tasks
