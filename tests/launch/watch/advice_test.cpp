// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/advice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

namespace shoal::launch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using Shares = std::map<std::string, double>;

ProcessTimes Role(const std::string& role, const Shares& shares) {
  ProcessTimes times{.role = role, .processes = 1, .seconds = 100, .cores = 1, .stages = {}};
  for (const auto& [stage, share] : shares) times.stages.push_back({stage, share});
  return times;
}

RunResources WithActors(int actors) { return {.usable_cores = 4, .actors = actors}; }

// A run in which nobody waits for anybody, on four cores.
Bottleneck Balanced() {
  return {.inserts_blocked = 0.05,
          .samples_blocked = 0.05,
          .roles = {Role("actor", {{"physics", 0.3}, {"rendering", 0.5}, {"waiting_credit", 0.05}}),
                    Role("replay", {{"idle", 0.8}, {"inserting", 0.1}, {"sampling", 0.1}}),
                    Role("learner", {{"backward", 0.6}, {"forward", 0.3}, {"waiting_data", 0.05}})},
          .cores = 2,
          .usable = 4,
          .advice = ""};
}

void SetShare(Bottleneck* figures, const std::string& role, const std::string& stage,
              double share) {
  for (ProcessTimes& times : figures->roles) {
    if (times.role != role) continue;
    std::erase_if(times.stages, [&](const StageShare& s) { return s.stage == stage; });
    times.stages.push_back({stage, share});
  }
}

TEST(Advice, BalancedRunsAreToldSoAndWhatTakesMost) {
  EXPECT_THAT(Advise(Balanced(), WithActors(2)),
              AllOf(HasSubstr("No process waits for another"), HasSubstr("backward (60 %")));
}

TEST(Advice, ALearnerHeldByTheLimiterWantsActorsWhileThereAreCores) {
  Bottleneck figures = Balanced();
  figures.samples_blocked = 0.4;
  EXPECT_THAT(Advise(figures, WithActors(2)), AllOf(HasSubstr("learner waits for the actors 40 %"),
                                                    HasSubstr("50 % of their time in rendering"),
                                                    HasSubstr("shoal scale --actors 3")));
  figures.cores = 3.9;
  EXPECT_THAT(Advise(figures, WithActors(2)),
              AllOf(HasSubstr("all 4 cores are busy"), HasSubstr("replay.samples_per_insert"),
                    Not(HasSubstr("shoal scale"))));
}

TEST(Advice, ActorsHeldByTheLimiterWantAFasterLearner) {
  Bottleneck figures = Balanced();
  figures.inserts_blocked = 0.7;
  EXPECT_THAT(Advise(figures, WithActors(2)),
              AllOf(HasSubstr("actors wait for it 70 % of the time"), HasSubstr("backward"),
                    HasSubstr("learner.threads"), HasSubstr("shoal scale --actors 1")));
  figures.cores = 4;
  EXPECT_THAT(Advise(figures, WithActors(2)),
              AllOf(HasSubstr("all 4 cores are busy"), HasSubstr("shoal scale"),
                    Not(HasSubstr("learner.threads"))));
}

TEST(Advice, WhoIsHeldLongerIsHelped) {
  Bottleneck figures = Balanced();
  figures.inserts_blocked = 0.3;
  figures.samples_blocked = 0.5;
  EXPECT_THAT(Advise(figures, WithActors(1)), HasSubstr("learner waits for the actors"));
  figures.inserts_blocked = 0.6;
  EXPECT_THAT(Advise(figures, WithActors(1)), HasSubstr("The learner sets the pace"));
}

TEST(Advice, TheOnlyActorStays) {
  Bottleneck figures = Balanced();
  figures.inserts_blocked = 0.7;
  EXPECT_THAT(Advise(figures, WithActors(1)), Not(HasSubstr("fewer actors")));
  SetShare(&figures, "replay", "sampling", 0.9);
  EXPECT_THAT(Advise(figures, WithActors(1)),
              AllOf(HasSubstr("replay server is busy"), Not(HasSubstr("fewer actors"))));
  EXPECT_THAT(Advise(figures, WithActors(2)), HasSubstr("fewer actors"));
}

TEST(Advice, AHostGetsNoMoreActorsThanItHasCores) {
  Bottleneck figures = Balanced();
  figures.samples_blocked = 0.4;
  EXPECT_THAT(Advise(figures, WithActors(3)), HasSubstr("shoal scale --actors 4"));
  EXPECT_THAT(Advise(figures, WithActors(4)),
              AllOf(HasSubstr("as many actors as cores (4)"), Not(HasSubstr("shoal scale"))));
  figures.limited = false;
  SetShare(&figures, "learner", "waiting_data", 0.6);
  EXPECT_THAT(Advise(figures, WithActors(4)), Not(HasSubstr("shoal scale")));
}

TEST(Advice, ActorsOfOtherHostsAreThoseOfTheHostsFile) {
  Bottleneck figures = Balanced();
  RunResources resources = WithActors(8);
  resources.actors_elsewhere = true;
  figures.samples_blocked = 0.4;
  EXPECT_THAT(Advise(figures, resources),
              AllOf(HasSubstr("--hosts"), Not(HasSubstr("shoal scale"))));
  figures.inserts_blocked = 0.7;
  EXPECT_THAT(Advise(figures, resources), Not(HasSubstr("shoal scale"))) << "which refuses there";
}

TEST(Advice, WhatTheRunWasAskedForIsNoFault) {
  Bottleneck figures = Balanced();
  figures.inserts_blocked = 0.7;
  EXPECT_THAT(Advise(figures, WithActors(1)),
              HasSubstr("A lower replay.samples_per_insert would make fewer updates"));
}

TEST(Advice, WaitsWithoutTheLimiterAreTheTransports) {
  Bottleneck figures = Balanced();
  SetShare(&figures, "learner", "waiting_data", 0.3);
  EXPECT_THAT(Advise(figures, WithActors(2)), HasSubstr("learner.request_credits"));
  figures = Balanced();
  SetShare(&figures, "actor", "waiting_credit", 0.3);
  EXPECT_THAT(Advise(figures, WithActors(2)), HasSubstr("replay.window_chunks"));
}

TEST(Advice, ABusyReplayIsNamedBeforeAnybodyWhoWaitsForIt) {
  Bottleneck figures = Balanced();
  figures.samples_blocked = 0.5;
  SetShare(&figures, "replay", "sampling", 0.75);
  EXPECT_THAT(Advise(figures, WithActors(2)), HasSubstr("replay server is busy"));
}

TEST(Advice, OnPolicyWhoeverWaitsLessHasTheLongerPart) {
  Bottleneck figures = Balanced();
  figures.limited = false;
  SetShare(&figures, "learner", "waiting_data", 0.6);
  EXPECT_THAT(Advise(figures, WithActors(2)), AllOf(HasSubstr("learner waits for rollouts 60 %"),
                                                    HasSubstr("shoal scale --actors 3")));
  SetShare(&figures, "actor", "weights", 0.7);
  EXPECT_THAT(Advise(figures, WithActors(2)),
              AllOf(HasSubstr("actors wait for weights 70 %"), HasSubstr("ppo.versions_ahead")));
  for (const std::string& line : FormatBottleneck(figures)) {
    EXPECT_THAT(line, Not(HasSubstr("limiter")));
  }
}

TEST(Advice, WithoutFiguresThereIsNone) {
  EXPECT_EQ(Advise(Bottleneck(), WithActors(1)), "Nothing has been measured yet.");
}

}  // namespace
}  // namespace shoal::launch
