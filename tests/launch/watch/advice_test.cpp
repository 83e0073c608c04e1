// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/advice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "common/base/files.h"
#include "tests/support/paths.h"

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

RunResources WithActors(int actors) {
  return {.usable_cores = 4, .actors = actors, .learner_threads = 1, .most_threads = 16};
}

// A run in which no role waits for another, on four cores.
Bottleneck Balanced() {
  return {.seconds = 100,
          .inserts_blocked = 0.05,
          .samples_blocked = 0.05,
          .roles = {Role("actor", {{"physics", 0.3}, {"rendering", 0.5}, {"waiting_credit", 0.05}}),
                    Role("replay", {{"idle", 0.8}, {"inserting", 0.1}, {"sampling", 0.1}}),
                    Role("learner", {{"backward", 0.6}, {"forward", 0.3}, {"waiting_data", 0.05}})},
          .cores = 2,
          .usable = 4,
          .advice = ""};
}

void SetCores(Bottleneck* figures, const std::string& role, double cores) {
  for (ProcessTimes& times : figures->roles) {
    if (times.role == role) times.cores = cores;
  }
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
              AllOf(HasSubstr("all 4 cores are busy"), Not(HasSubstr("shoal scale"))));
}

TEST(Advice, AStageIsNamedInWords) {
  Bottleneck figures = Balanced();
  figures.samples_blocked = 0.4;
  SetShare(&figures, "actor", "user_code", 0.6);
  EXPECT_THAT(Advise(figures, WithActors(2)), HasSubstr("60 % of their time in user code)"));
  SetShare(&figures, "actor", "conversion", 0.7);
  EXPECT_THAT(Advise(figures, WithActors(2)), HasSubstr("70 % of their time in conversion)"));
}

// Two actors at 15 % of their time are 0.3 cores; with the replay server there are three for the
// learner, which then wants 0.9 cores of actors. Three threads make 3 / 1.06 times the updates.
TEST(Advice, ActorsHeldByTheLimiterLeaveTheirCoresToTheLearner) {
  Bottleneck figures = Balanced();
  figures.inserts_blocked = 0.85;
  SetShare(&figures, "actor", "waiting_credit", 0.85);
  SetCores(&figures, "replay", 0.01);
  EXPECT_THAT(Advise(figures, WithActors(2)),
              AllOf(HasSubstr("actors wait for it 85 % of the time"), HasSubstr("backward"),
                    HasSubstr("about 2.8 times as fast with --set learner.threads=3 --set "
                              "actors=1 at the next start")));
  RunResources few_rows = WithActors(2);
  few_rows.most_threads = 2;
  EXPECT_THAT(Advise(figures, few_rows), HasSubstr("learner.threads=2"));
}

TEST(Advice, ADivisionThatGainsLittleIsNotNamed) {
  Bottleneck figures = Balanced();
  figures.inserts_blocked = 0.85;
  SetShare(&figures, "actor", "waiting_credit", 0.85);
  SetCores(&figures, "replay", 1.9);  // leaves the learner no second core
  figures.cores = 4;
  EXPECT_THAT(Advise(figures, WithActors(2)),
              AllOf(HasSubstr("all 4 cores are busy"), Not(HasSubstr("--set"))));
}

// The learner waited for data although the actors waited for it. The best split repeats those
// waits.
TEST(Advice, ASplitGainsNothingByWaitsThatThePresentOneHasToo) {
  Bottleneck figures = Balanced();
  figures.inserts_blocked = 0.84;
  SetShare(&figures, "actor", "waiting_credit", 0.84);
  SetShare(&figures, "learner", "waiting_data", 0.16);
  SetCores(&figures, "replay", 0.01);
  RunResources one_thread = WithActors(1);
  one_thread.most_threads = 1;
  EXPECT_THAT(Advise(figures, one_thread),
              AllOf(HasSubstr("actors wait for it 84 %"), Not(HasSubstr("--set"))))
      << "one thread and one actor are the best split already";
  one_thread.actors = 4;
  EXPECT_THAT(Advise(figures, one_thread), Not(HasSubstr("--set")))
      << "fewer actors beside as many threads are no faster";
  EXPECT_THAT(Advise(figures, WithActors(1)),
              HasSubstr("about 2.8 times as fast with --set learner.threads=3 --set actors=1"));
}

TEST(Advice, InTheFirstSecondsAndBeforeTheFirstUpdateThereIsNone) {
  Bottleneck figures = Balanced();
  figures.samples_blocked = 0.9;
  figures.seconds = kLeastSeconds - 1;
  EXPECT_EQ(Advise(figures, WithActors(2)), "");
  figures.seconds = kLeastSeconds;
  EXPECT_NE(Advise(figures, WithActors(2)), "");
  figures.roles.back() = Role("learner", {{"waiting_data", 1}});
  EXPECT_EQ(Advise(figures, WithActors(2)), "");
}

// bottleneck.json as a run wrote it.
Bottleneck Recorded(const std::string& name) {
  const auto json = nlohmann::json::parse(ReadFile(GoldenPath("bottleneck/" + name)));
  Bottleneck figures{.inserts_blocked = json.at("limiter").at("blocked_insert_share"),
                     .samples_blocked = json.at("limiter").at("blocked_sample_share"),
                     .cores = json.at("cores_used"),
                     .usable = json.at("cores_usable")};
  for (const auto& role : json.at("roles")) {
    figures.seconds = std::max(figures.seconds, role.at("seconds").get<double>());
    figures.roles.push_back({.role = role.at("role"),
                             .processes = role.at("processes"),
                             .seconds = role.at("seconds"),
                             .cores = role.at("cores")});
    for (const auto& [stage, share] : role.at("shares").items()) {
      figures.roles.back().stages.push_back({stage, share});
    }
  }
  return figures;
}

TEST(Advice, ARecordedRunOnTwoBusyCoresIsToldOfNoChange) {
  const std::string advice =
      Advise(Recorded("flagship_2_cores.json"),
             {.usable_cores = 2, .actors = 1, .learner_threads = 2, .most_threads = 16});
  EXPECT_THAT(advice, AllOf(HasSubstr("actors wait for it 71 %"), HasSubstr("all 2 cores are busy"),
                            Not(HasSubstr("--set")), Not(HasSubstr("samples_per_insert"))));
}

TEST(Advice, ARecordedRunOnSixteenCoresIsToldOfASplitThatUsesThem) {
  EXPECT_THAT(Advise(Recorded("flagship_16_cores.json"),
                     {.usable_cores = 16, .actors = 8, .learner_threads = 8, .most_threads = 16}),
              AllOf(HasSubstr("actors wait for it 87 %"), HasSubstr("about 1.3 times as fast with"),
                    HasSubstr("--set learner.threads=11 --set actors=5")));
}

TEST(Advice, WhoIsHeldLongerIsHelped) {
  Bottleneck figures = Balanced();
  figures.inserts_blocked = 0.3;
  figures.samples_blocked = 0.5;
  EXPECT_THAT(Advise(figures, WithActors(1)), HasSubstr("learner waits for the actors"));
  figures.inserts_blocked = 0.6;
  EXPECT_THAT(Advise(figures, WithActors(1)), HasSubstr("The learner sets the pace"));
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
  RunResources resources = WithActors(2);
  figures.samples_blocked = 0.4;
  EXPECT_THAT(Advise(figures, resources), HasSubstr("shoal scale"));
  resources.actors_elsewhere = true;
  EXPECT_THAT(Advise(figures, resources),
              AllOf(HasSubstr("--hosts"), Not(HasSubstr("shoal scale"))));
  figures.inserts_blocked = 0.85;
  SetShare(&figures, "actor", "waiting_credit", 0.85);
  SetCores(&figures, "replay", 0.01);
  EXPECT_THAT(Advise(figures, WithActors(2)), HasSubstr("--set"));
  EXPECT_THAT(Advise(figures, resources), Not(HasSubstr("--set")))
      << "the cores of this host are not those of the actors";
}

TEST(Advice, WaitsWithoutTheLimiterAreTheTransports) {
  Bottleneck figures = Balanced();
  SetShare(&figures, "learner", "waiting_data", 0.3);
  EXPECT_THAT(Advise(figures, WithActors(2)),
              AllOf(HasSubstr("raise learner.request_credits"), Not(HasSubstr("replay.threads"))));
  figures = Balanced();
  SetShare(&figures, "actor", "waiting_credit", 0.3);
  EXPECT_THAT(Advise(figures, WithActors(2)), HasSubstr("replay.window_chunks"));
}

// The shares of a measured run with a GPU: the actors wait because the learner waits for batches.
TEST(Advice, ALearnerThatWaitsForGrantedBatchesDoesNotSetThePace) {
  Bottleneck figures = Balanced();
  figures.inserts_blocked = 0.65;
  figures.samples_blocked = 0.01;
  SetShare(&figures, "learner", "waiting_data", 0.42);
  SetShare(&figures, "replay", "inserting", 0.15);
  SetShare(&figures, "replay", "sampling", 0.58);
  EXPECT_THAT(Advise(figures, WithActors(2)),
              AllOf(HasSubstr("learner waits for batches 42 %"),
                    HasSubstr("the replay server sets the pace (15 % inserting, 58 % sampling)"),
                    HasSubstr("raise replay.threads"), Not(HasSubstr("learner sets the pace"))));
  SetShare(&figures, "learner", "waiting_data", 0.2);
  EXPECT_THAT(Advise(figures, WithActors(2)), HasSubstr("The learner sets the pace"))
      << "without the limiter's share, the learner waits less than 20 %";
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
              AllOf(HasSubstr("actors for weights 70 %"), Not(HasSubstr("ppo."))));
  RunResources ahead = WithActors(2);
  ahead.may_play_ahead = true;
  EXPECT_THAT(Advise(figures, ahead), HasSubstr("--set ppo.versions_ahead=1"));
  for (const std::string& line : FormatBottleneck(figures)) {
    EXPECT_THAT(line, Not(HasSubstr("limiter")));
  }
}

TEST(Advice, WithoutFiguresThereIsNone) { EXPECT_EQ(Advise(Bottleneck(), WithActors(1)), ""); }

}  // namespace
}  // namespace shoal::launch
