// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/process_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Pair;

TEST(PlanProcesses, StartsServersBeforeActorsAndOneProcessPerActor) {
  Config config;
  config.actors = 2;
  config.learner.threads = 3;
  std::vector<std::string> names;
  for (const ProcessSpec& spec : PlanProcesses(TopologyOf(config, {}), config, "runs/a")) {
    names.push_back(spec.Name());
    EXPECT_EQ(spec.outlives_parent, spec.role == "replay");
    EXPECT_EQ(spec.expendable, spec.role == "actor" || spec.role == "eval");
    EXPECT_EQ(spec.output, "runs/a/logs/" + spec.Name() + ".log");
    EXPECT_THAT(spec.environment, Contains(Pair("OMP_WAIT_POLICY", "passive")));
    EXPECT_THAT(spec.environment, Contains(Pair("LP_NUM_THREADS", "0")));
    EXPECT_THAT(spec.environment,
                Contains(Pair("OMP_NUM_THREADS", spec.role == "learner" ? "3" : "1")));
  }
  EXPECT_THAT(names, ElementsAre("replay-0", "learner-0", "actor-0", "actor-1", "eval-0"));
}

TEST(PlanProcesses, WithoutAReplayTheLearnerAcknowledgesTheLastRecords) {
  Config config;
  config.actors = 1;
  config.learner.algorithm = "ppo";
  std::vector<std::string> names;
  for (const ProcessSpec& spec : PlanProcesses(TopologyOf(config, {}), config, "runs/a")) {
    names.push_back(spec.Name());
    EXPECT_EQ(spec.outlives_parent, spec.role == "learner") << spec.Name();
  }
  EXPECT_THAT(names, ElementsAre("learner-0", "actor-0", "eval-0"));
}

TEST(PlanProcesses, InLockstepTheRunNeedsEveryProcess) {
  Config config;
  config.actors = 1;
  config.lockstep = true;
  for (const ProcessSpec& spec : PlanProcesses(TopologyOf(config, {}), config, "runs/a")) {
    EXPECT_FALSE(spec.expendable) << spec.Name();
  }
}

TEST(PlanProcesses, GivesEachProgramItsArguments) {
  Config config;
  config.actors = 2;
  const auto plan = PlanProcesses(TopologyOf(config, {}), config, "runs/a");
  const std::string folder = ProgramFolder();
  EXPECT_THAT(plan[0].command, ElementsAre(folder + "/shoal-replay", "--run", "runs/a"));
  EXPECT_THAT(plan[1].command, ElementsAre(folder + "/shoal-learner", "--run", "runs/a"));
  EXPECT_THAT(plan[3].command,
              ElementsAre(folder + "/shoal-actor", "--run", "runs/a", "--id", "1"));
  EXPECT_THAT(plan[4].command,
              ElementsAre(folder + "/shoal-actor", "--run", "runs/a", "--role", "eval"));
}

}  // namespace
}  // namespace shoal::launch
