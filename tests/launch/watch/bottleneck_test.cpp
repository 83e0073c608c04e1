#include "launch/watch/bottleneck.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "common/base/files.h"
#include "tests/launch/watch/report_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using Shares = std::map<std::string, double>;

ProcessTimes Role(const std::string& role, const Shares& shares) {
  ProcessTimes times{.role = role, .processes = 1, .seconds = 100, .cores = 1, .stages = {}};
  for (const auto& [stage, share] : shares) times.stages.push_back({stage, share});
  return times;
}

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
  EXPECT_THAT(Advise(Balanced(), 2), AllOf(HasSubstr("Nobody waits"), HasSubstr("backward (60 %")));
}

TEST(Advice, ALearnerHeldByTheLimiterWantsActorsWhileThereAreCores) {
  Bottleneck figures = Balanced();
  figures.samples_blocked = 0.4;
  EXPECT_THAT(Advise(figures, 2), AllOf(HasSubstr("learner waits for the actors 40 %"),
                                        HasSubstr("50 % of their time in rendering"),
                                        HasSubstr("shoal scale --actors 3")));
  figures.cores = 3.9;
  EXPECT_THAT(Advise(figures, 2),
              AllOf(HasSubstr("all 4 cores are busy"), HasSubstr("replay.samples_per_insert"),
                    Not(HasSubstr("shoal scale"))));
}

TEST(Advice, ActorsHeldByTheLimiterWantAFasterLearner) {
  Bottleneck figures = Balanced();
  figures.inserts_blocked = 0.7;
  EXPECT_THAT(Advise(figures, 2),
              AllOf(HasSubstr("actors wait for the learner 70 %"), HasSubstr("backward"),
                    HasSubstr("learner.threads"), HasSubstr("lower replay.samples_per_insert")));
  figures.cores = 4;
  EXPECT_THAT(Advise(figures, 2), AllOf(HasSubstr("all 4 cores are busy"), HasSubstr("shoal scale"),
                                        Not(HasSubstr("learner.threads"))));
}

TEST(Advice, WhoIsHeldLongerIsHelped) {
  Bottleneck figures = Balanced();
  figures.inserts_blocked = 0.3;
  figures.samples_blocked = 0.5;
  EXPECT_THAT(Advise(figures, 1), HasSubstr("learner waits for the actors"));
  figures.inserts_blocked = 0.6;
  EXPECT_THAT(Advise(figures, 1), HasSubstr("actors wait for the learner"));
}

TEST(Advice, WaitsWithoutTheLimiterAreTheTransports) {
  Bottleneck figures = Balanced();
  SetShare(&figures, "learner", "waiting_data", 0.3);
  EXPECT_THAT(Advise(figures, 2), HasSubstr("learner.request_credits"));
  figures = Balanced();
  SetShare(&figures, "actor", "waiting_credit", 0.3);
  EXPECT_THAT(Advise(figures, 2), HasSubstr("replay.window_chunks"));
}

TEST(Advice, ABusyReplayIsNamedBeforeAnybodyWhoWaitsForIt) {
  Bottleneck figures = Balanced();
  figures.samples_blocked = 0.5;
  SetShare(&figures, "replay", "sampling", 0.75);
  EXPECT_THAT(Advise(figures, 2), HasSubstr("replay server is busy"));
}

TEST(Advice, OnPolicyWhoeverWaitsLessHasTheLongerPart) {
  Bottleneck figures = Balanced();
  figures.limited = false;
  SetShare(&figures, "learner", "waiting_data", 0.6);
  EXPECT_THAT(Advise(figures, 2), AllOf(HasSubstr("learner waits for rollouts 60 %"),
                                        HasSubstr("shoal scale --actors 3")));
  SetShare(&figures, "actor", "weights", 0.7);
  EXPECT_THAT(Advise(figures, 2),
              AllOf(HasSubstr("actors wait for weights 70 %"), HasSubstr("ppo.versions_ahead")));
  for (const std::string& line : FormatBottleneck(figures)) {
    EXPECT_THAT(line, Not(HasSubstr("limiter")));
  }
}

TEST(Advice, WithoutFiguresThereIsNone) {
  EXPECT_EQ(Advise(Bottleneck(), 1), "Nothing was measured.");
}

// Two actors, one of which was restarted; every process has run for 10 s in all.
MetricsView ViewOfARun() {
  MetricsView view;
  const SteadyTime start = Now();
  const auto report = [&](const char* role, uint32_t id, int32_t pid, double at, const Shares& f) {
    view.OnMessage(Report(role, id, pid, at, f), start + std::chrono::milliseconds(int(at * 1000)));
  };
  report("actor", 0, 1, 10, {{"uptime_seconds", 10}, {"seconds_physics", 4}, {"cpu_seconds", 8}});
  report("actor", 1, 2, 6, {{"uptime_seconds", 6}, {"seconds_physics", 1}, {"cpu_seconds", 3}});
  report("actor", 1, 3, 10, {{"uptime_seconds", 4}, {"seconds_physics", 2}, {"cpu_seconds", 1}});
  report("replay", 0, 4, 10,
         {{"uptime_seconds", 10}, {"limiter_blocked_sample_seconds", 5}, {"seconds_sending", 9}});
  report("learner", 0, 5, 10, {{"uptime_seconds", 10}, {"seconds_backward", 10}});
  return view;
}

TEST(Bottleneck, SharesAreOfTheTimeThatTheRolesProcessesRan) {
  const Bottleneck found = FindBottleneck(ViewOfARun(), 4, 2);
  ASSERT_EQ(found.roles.size(), 3u);
  const ProcessTimes& actor = found.roles[0];
  EXPECT_EQ(actor.role, "actor");
  EXPECT_EQ(actor.processes, 2);
  EXPECT_DOUBLE_EQ(actor.seconds, 20);
  EXPECT_DOUBLE_EQ(actor.cores, 1.2);  // 12 s of processor time in the 10 s that both ran
  ASSERT_EQ(actor.stages.size(), 2u);
  EXPECT_EQ(actor.stages[0].stage, "other");
  EXPECT_DOUBLE_EQ(actor.stages[0].share, 0.65);
  EXPECT_EQ(actor.stages[1].stage, "physics");
  EXPECT_DOUBLE_EQ(actor.stages[1].share, 0.35);
  EXPECT_DOUBLE_EQ(found.samples_blocked, 0.5);
}

TEST(Bottleneck, WhatRunsOnAThreadOfItsOwnTakesNothingFromTheRest) {
  const Bottleneck found = FindBottleneck(ViewOfARun(), 4, 2);
  const ProcessTimes& replay = found.roles[1];
  ASSERT_EQ(replay.stages.size(), 2u);
  EXPECT_EQ(replay.stages[0].stage, "other");
  EXPECT_DOUBLE_EQ(replay.stages[0].share, 1);
  EXPECT_DOUBLE_EQ(replay.stages[1].share, 0.9);
}

TEST(Bottleneck, IsStoredAsItIsSaid) {
  const TemporaryFolder run;
  const Bottleneck found = FindBottleneck(ViewOfARun(), 4, 2);
  WriteBottleneck(run.path(), found);
  const auto json = nlohmann::json::parse(ReadFile(run.path() / "bottleneck.json"));
  EXPECT_EQ(json.at("schema"), "shoal-bottleneck-1");
  EXPECT_EQ(json.at("advice"), found.advice);
  EXPECT_EQ(json.at("roles")[0].at("shares").at("physics"), 0.35);
  EXPECT_EQ(json.at("limiter").at("blocked_sample_share"), 0.5);
  const auto lines = FormatBottleneck(found);
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_THAT(lines[0], AllOf(HasSubstr("actor x2"), HasSubstr("physics 35 %")));
  EXPECT_THAT(lines[3], HasSubstr("the learner 50 %"));
  EXPECT_EQ(lines[4], found.advice);
}

}  // namespace
}  // namespace shoal::launch
