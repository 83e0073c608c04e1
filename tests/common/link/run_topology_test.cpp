// SPDX-License-Identifier: Apache-2.0
#include "common/link/run_topology.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

namespace shoal::link {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::string> Names(const std::vector<RunProcess>& processes) {
  std::vector<std::string> names;
  for (const RunProcess& process : processes) names.push_back(process.Name().Text());
  return names;
}

Config TwoActors() {
  Config config;
  config.actors = 2;
  return config;
}

Config OnPolicy() {
  Config config = TwoActors();
  config.learner.algorithm = "ppo";
  return config;
}

TEST(RunTopology, ListsTheChildrenInStartingOrder) {
  EXPECT_THAT(Names(RunTopology(TwoActors()).children()),
              ElementsAre("replay-0", "learner-0", "actor-0", "actor-1", "eval-0"));
  EXPECT_THAT(Names(RunTopology(OnPolicy()).children()),
              ElementsAre("learner-0", "actor-0", "actor-1", "eval-0"));
}

TEST(RunTopology, TheLastActorsRunOnTheOtherHosts) {
  Config config;
  config.actors = 6;
  const int elsewhere[] = {3, 2};
  const RunTopology topology(config, elsewhere);
  EXPECT_THAT(Names(topology.ActorsOn(0)), ElementsAre("actor-0"));
  EXPECT_THAT(Names(topology.ActorsOn(1)), ElementsAre("actor-1", "actor-2", "actor-3"));
  EXPECT_THAT(Names(topology.ActorsOn(2)), ElementsAre("actor-4", "actor-5"));
  EXPECT_EQ(topology.OnlyLearner().host, 0u);
}

TEST(RunTopologyDeathTest, HostsWithMoreActorsThanTheRunAreABug) {
  const int elsewhere[] = {3};
  EXPECT_DEATH(RunTopology(TwoActors(), elsewhere), "1 more on other hosts");
}

TEST(RunTopology, NamesTheOneLearnerAndTheOneReplay) {
  const RunTopology topology(TwoActors());
  EXPECT_EQ(topology.OnlyLearner().Name().Text(), "learner-0");
  EXPECT_EQ(topology.OnlyReplay().Name().Text(), "replay-0");
  EXPECT_TRUE(topology.Has(Role::kReplay));
  EXPECT_FALSE(RunTopology(OnPolicy()).Has(Role::kReplay));
  EXPECT_EQ(RunTopology(OnPolicy()).OnlyLearner().Name().Text(), "learner-0");
}

TEST(RunTopologyDeathTest, ARunWithoutAReplayHasNotOne) {
  EXPECT_DEATH(RunTopology(OnPolicy()).OnlyReplay(), "0 processes of role replay");
}

TEST(RunTopology, RecordsGoToTheReplayOrElseToTheLearner) {
  EXPECT_THAT(Names(RunTopology(TwoActors()).RecordReceivers()), ElementsAre("replay-0"));
  EXPECT_THAT(Names(RunTopology(TwoActors()).WritersOf<CreditsMessage>()), ElementsAre("replay-0"));
  EXPECT_THAT(Names(RunTopology(OnPolicy()).RecordReceivers()), ElementsAre("learner-0"));
  EXPECT_THAT(Names(RunTopology(OnPolicy()).WritersOf<CreditsMessage>()), ElementsAre("learner-0"));
}

TEST(RunTopology, OtherTopicsFollowTheRightsOfRoles) {
  const RunTopology topology(TwoActors());
  EXPECT_THAT(Names(topology.ReadersOf<CreditsMessage>()), ElementsAre("actor-0", "actor-1"));
  EXPECT_THAT(Names(topology.ReadersOf<SampleRequest>()), ElementsAre("replay-0"));
  EXPECT_THAT(Names(topology.ReadersOf<EvalWeightsPart>()), ElementsAre("eval-0"));
  EXPECT_EQ(topology.ReadersOf<ControlMessage>(), topology.children());
  EXPECT_THAT(topology.ReadersOf<CommandMessage>(), IsEmpty()) << "the coordinator reads it";
}

TEST(RunTopology, OnlyProcessesOfTheRunWriteInTheirName) {
  const RunTopology topology(TwoActors());
  EXPECT_TRUE(topology.CanWrite<ActorMetrics>("actor", kMostActors - 1)) << "shoal scale";
  EXPECT_FALSE(topology.CanWrite<ActorMetrics>("actor", kMostActors));
  EXPECT_FALSE(topology.CanWrite<ActorMetrics>("learner", 0));
  EXPECT_FALSE(topology.CanWrite<LearnerMetrics>("actor", 0));
  EXPECT_TRUE(topology.CanWrite<LearnerMetrics>("learner", 0));
  EXPECT_FALSE(topology.CanWrite<LearnerMetrics>("learner", 1));
  EXPECT_TRUE(topology.CanWrite<ReplayProgress>("replay", 0));
  EXPECT_FALSE(RunTopology(OnPolicy()).CanWrite<ReplayProgress>("replay", 0));
}

TEST(RunTopology, ServersHaveFixedPortsAndOthersNone) {
  EXPECT_EQ(FixedPort(Role::kCoordinator, 0), 0);
  EXPECT_EQ(FixedPort(Role::kLearner, 0), 1);
  EXPECT_EQ(FixedPort(Role::kReplay, 0), 2);
  EXPECT_FALSE(FixedPort(Role::kReplay, 1));
  EXPECT_FALSE(FixedPort(Role::kActor, 0));
  std::set<std::string> servers{"coordinator"};
  const RunTopology topology(TwoActors());
  for (const RunProcess& child : topology.children()) {
    if (FixedPort(child.role, child.index)) servers.insert(RoleName(child.role));
  }
  EXPECT_THAT(servers, ElementsAre("coordinator", "learner", "replay"));
}

}  // namespace
}  // namespace shoal::link
