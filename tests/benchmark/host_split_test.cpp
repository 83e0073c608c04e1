// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/host_split.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"

namespace shoal::bench {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

// An actor makes 100 env steps a second; the replay server takes 1 ms of each, batches are free.
constexpr ScaleConstants kSimple{.actor_rate = 100, .intake = 1e-3, .update = 0.128};

const LearnerSpeed kPerfect({{1, 1.0}, {1000, 1000.0}});

TEST(LearnerSpeed, IsLinearBetweenMeasuredNumbersAndConstantAfterTheFastest) {
  const LearnerSpeed speed({{1, 1.0}, {4, 2.5}, {8, 4.0}, {16, 3.0}});
  EXPECT_DOUBLE_EQ(speed.Of(1), 1);
  EXPECT_DOUBLE_EQ(speed.Of(2), 1.5);
  EXPECT_DOUBLE_EQ(speed.Of(4), 2.5);
  EXPECT_DOUBLE_EQ(speed.Of(8), 4);
  EXPECT_DOUBLE_EQ(speed.Of(12), 4);
  EXPECT_DOUBLE_EQ(speed.Of(100), 4);
}

TEST(LearnerSpeed, IsTheMeanEfficiencyOfAFileTimesTheThreads) {
  const LearnerSpeed speed(R"({"schema": "shoal-scaling-1", "rows": [
    {"network": "compact", "batch": 128, "threads": 4, "efficiency": 0.5},
    {"network": "compact", "batch": 128, "threads": 4, "efficiency": 1.0},
    {"network": "compact", "batch": 256, "threads": 4, "efficiency": 0.1},
    {"network": "nature", "batch": 128, "threads": 4, "efficiency": 0.1}]})",
                           "file");
  EXPECT_DOUBLE_EQ(speed.Of(4), 3);
  EXPECT_DOUBLE_EQ(speed.Of(1), 1);
  EXPECT_THAT([] { LearnerSpeed("{}", "a file"); },
              ThrowsMessage<Error>(AllOf(HasSubstr("a file"), HasSubstr("shoal-scaling-1"))));
}

TEST(HostSplit, OfMostEnvStepsIsTaken) {
  // A learner thread learns from 1000 / S env steps a second: at S = 10 from those of one actor,
  // which needs a tenth of a core of the replay server, too.
  const HostSplit even = BestSplit(kSimple, kPerfect, 1, 22, 10);
  EXPECT_EQ(even.learner_threads, 10);
  EXPECT_NEAR(even.env_steps_per_second, 1000, 1e-9);
  EXPECT_NEAR(even.actor_cores, 10, 1e-9);
  EXPECT_NEAR(even.replay_cores, 1, 1e-9);
  // Actors that slow each other down leave less for the learner.
  EXPECT_LT(BestSplit(kSimple, kPerfect, 0.5, 22, 10).learner_threads, 10);
  // A learner that gains nothing from a second thread limits the run; the other cores idle.
  const HostSplit idle = BestSplit(kSimple, LearnerSpeed({{1, 1.0}}), 1, 21, 10);
  EXPECT_EQ(idle.learner_threads, 1);
  EXPECT_NEAR(idle.env_steps_per_second, 100, 1e-9);
}

TEST(HostSplit, NeedsARowOfActorsOnAllCores) {
  const auto row = [](const char* stage) {
    ReportedRow made;
    made.stage = stage;
    made.figure = 1;
    made.against_figure = 1;
    made.ratio = 0.8;
    return made;
  };
  Report report;
  report.rows = {row("1 actor of FetchReach with one 84x84 camera, fast"),
                 row("replay server under 16 actor processes"),
                 row("128 samples of (3, 84, 84), drawn and shifted, of 200000 records"),
                 row("batches handed to a learner on the same host, beside the gather"),
                 row("SAC update, compact, batch 128 of (6, 84, 84), auto")};
  EXPECT_THAT(
      [&] {
        HostTable({&report, 1}, kPerfect);
      },
      ThrowsMessage<Error>(HasSubstr("N actors of FetchReach on N cores")));
  report.rows.push_back(row("2 actors of FetchReach with one 84x84 camera, fast, on 2 cores"));
  report.rows.push_back(row("16 actors of FetchReach with one 84x84 camera, fast, on 16 cores"));
  report.rows.push_back(
      row("32 actors of FetchReach with one 84x84 camera, fast, on 32 cores, and more"));
  EXPECT_THAT(HostTable({&report, 1}, kPerfect),
              AllOf(HasSubstr("16 actors on 16 cores make 0.80 of 16 times the env steps"),
                    HasSubstr("| 128 | 64 |")));
}

}  // namespace
}  // namespace shoal::bench
