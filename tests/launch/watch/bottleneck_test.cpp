// SPDX-License-Identifier: Apache-2.0
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

using ::testing::AllOf;
using ::testing::HasSubstr;

using Shares = std::map<std::string, double>;

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
  const Bottleneck found = FindBottleneck(TotalsOf(ViewOfARun()), {.usable_cores = 4, .actors = 2});
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
  const Bottleneck found = FindBottleneck(TotalsOf(ViewOfARun()), {.usable_cores = 4, .actors = 2});
  const ProcessTimes& replay = found.roles[1];
  ASSERT_EQ(replay.stages.size(), 2u);
  EXPECT_EQ(replay.stages[0].stage, "other");
  EXPECT_DOUBLE_EQ(replay.stages[0].share, 1);
  EXPECT_DOUBLE_EQ(replay.stages[1].share, 0.9);
}

TEST(Bottleneck, SharesAreNeverMoreThanTheWhole) {
  RunTotals totals;
  totals["replay"] = {
      .processes = 1, .seconds = 10, .stages = {{"sending", 36}}, .samples_blocked = 11};
  const Bottleneck found = FindBottleneck(totals, {});
  EXPECT_EQ(ShareOf(found, "replay", "sending"), 1) << "a send that began before has ended";
  EXPECT_EQ(found.samples_blocked, 1);
}

TEST(Bottleneck, IsStoredAsItIsSaid) {
  const TemporaryFolder run;
  const Bottleneck found = FindBottleneck(TotalsOf(ViewOfARun()), {.usable_cores = 4, .actors = 2});
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
