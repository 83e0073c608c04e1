// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/ordered_stop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/base/files.h"
#include "tests/launch/wait_until.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Fake programs react to an announcement: they wait for a file with its name.
class OrderedStop : public ::testing::Test {
 protected:
  void Start(const std::string& role, const std::string& script) {
    ProcessSpec spec;
    spec.role = role;
    spec.command = {"/bin/sh", "-c", script};
    spec.output = folder_.path() / (role + ".log");
    supervisor_.Start(spec);
  }
  // Leaves after the announcement and writes its role into the order of leaving.
  void StartObedient(const std::string& role, const std::string& announcement) {
    const std::string folder = folder_.path().string();
    Start(role, "while [ ! -e " + folder + "/" + announcement + " ]; do sleep 0.01; done; echo " +
                    role + " >> " + folder + "/left");
  }
  StopHooks Hooks() {
    return {.announce =
                [this](RunState state) {
                  const bool draining = state == RunState::kDraining;
                  WriteFileAtomically(folder_.path() / (draining ? "draining" : "stopping"), "");
                  announced_.push_back(state);
                },
            .tick = [this] { ++ticks_; },
            .at_once = [this] { return at_once_; },
            .say = [this](const std::string& line) { said_.push_back(line); }};
  }
  std::string Left() const {
    const auto file = folder_.path() / "left";
    return std::filesystem::exists(file) ? ReadFile(file) : "";
  }

  TemporaryFolder folder_;
  std::vector<std::string> said_;
  std::vector<RunState> announced_;
  int ticks_ = 0;
  bool at_once_ = false;
  Supervisor supervisor_{RestartLimits(), HangLimits(),
                         [this](const std::string& line) { said_.push_back(line); }};
};

constexpr StopDeadlines kPatient{};
constexpr StopDeadlines kQuickStop{.drain = milliseconds(100),
                                   .settle = milliseconds(100),
                                   .finish = milliseconds(100),
                                   .terminate = milliseconds(200)};

TEST_F(OrderedStop, ActorsLeaveBeforeAnybodyElseIsTold) {
  StartObedient("replay", "stopping");
  StartObedient("learner", "stopping");
  StartObedient("actor", "draining");
  StartObedient("eval", "stopping");
  StopInOrder(supervisor_, kPatient, Hooks());
  EXPECT_THAT(announced_, ElementsAre(RunState::kDraining, RunState::kStopping));
  EXPECT_TRUE(Left().starts_with("actor\n")) << Left();
  EXPECT_EQ(std::ranges::count(Left(), '\n'), 4);
  EXPECT_EQ(supervisor_.Running(""), 0);
  EXPECT_GT(ticks_, 0);
  EXPECT_THAT(said_, IsEmpty());
}

TEST_F(OrderedStop, OverdueProcessesGetSigterm) {
  Start("actor", "exec sleep 60");
  StopInOrder(supervisor_, kQuickStop, Hooks());
  EXPECT_EQ(supervisor_.Running(""), 0);
  EXPECT_THAT(said_, ElementsAre(HasSubstr("SIGTERM")));
  EXPECT_THAT(supervisor_.unclean_exits(), IsEmpty()) << "it ended in order";
}

TEST_F(OrderedStop, ThoseThatIgnoreItGetSigkill) {
  const auto armed = folder_.path() / "armed";
  Start("learner", "trap '' TERM; touch " + armed.string() + "; while true; do sleep 0.05; done");
  ASSERT_TRUE(WaitUntil([&] { return std::filesystem::exists(armed); }));
  StopInOrder(supervisor_, kQuickStop, Hooks());
  EXPECT_EQ(supervisor_.Running(""), 0);
  EXPECT_THAT(supervisor_.unclean_exits(), ElementsAre(HasSubstr("killed by SIGKILL")));
}

TEST_F(OrderedStop, AtOnceDoesNotWaitForTheDeadlines) {
  Start("actor", "exec sleep 60");
  Start("learner", "exec sleep 60");
  at_once_ = true;
  const SteadyTime start = Now();
  StopInOrder(supervisor_, kPatient, Hooks());
  EXPECT_LT(SecondsSince(start), 5);
  EXPECT_EQ(supervisor_.Running(""), 0);
}

TEST_F(OrderedStop, WaitsForTheLastEvaluationAfterTheActorsLeft) {
  StartObedient("actor", "draining");
  StartObedient("eval", "stopping");
  StopHooks hooks = Hooks();
  int asked = 0;
  hooks.settled = [&] {
    EXPECT_EQ(supervisor_.Running("actor"), 0);
    EXPECT_EQ(announced_.size(), 1u) << "told to stop before it settled";
    return ++asked == 3;
  };
  StopInOrder(supervisor_, kPatient, hooks);
  EXPECT_EQ(asked, 3);
}

// The evaluation takes several times as long as the wait without work.
TEST_F(OrderedStop, WaitsForTheLastEvaluationWhileItIsPlayed) {
  StartObedient("eval", "stopping");
  StopHooks hooks = Hooks();
  StopDeadlines deadlines;
  deadlines.settle = milliseconds(400);
  const SteadyTime start = Now();
  hooks.work = [&] { return std::floor(SecondsSince(start) / 0.1); };
  hooks.settled = [&] { return SecondsSince(start) > 1.5; };
  StopInOrder(supervisor_, deadlines, hooks);
  EXPECT_GT(SecondsSince(start), 1.5);
  EXPECT_THAT(said_, IsEmpty());
}

TEST_F(OrderedStop, WorkThatNeverEndsIsNotAwaitedForEver) {
  StartObedient("eval", "stopping");
  StopHooks hooks = Hooks();
  hooks.settled = [] { return false; };
  hooks.work = [work = 0.0]() mutable { return ++work; };
  StopDeadlines deadlines;
  deadlines.settle_in_all = milliseconds(300);
  StopInOrder(supervisor_, deadlines, hooks);
  EXPECT_THAT(said_, ElementsAre(HasSubstr("did not come in time")));
  EXPECT_EQ(supervisor_.Running(""), 0);
}

TEST_F(OrderedStop, DoesNotWaitForEverForTheLastEvaluation) {
  StartObedient("eval", "stopping");
  StopHooks hooks = Hooks();
  hooks.settled = [] { return false; };
  StopDeadlines deadlines;
  deadlines.settle = milliseconds(100);
  StopInOrder(supervisor_, deadlines, hooks);
  EXPECT_THAT(said_, ElementsAre(HasSubstr("did not come in time")));
  EXPECT_EQ(supervisor_.Running(""), 0);
}

}  // namespace
}  // namespace shoal::launch
