// A running run as those see it who watch it and steer it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <set>

#include "tests/support/run_views.h"
#include "tests/support/running_training.h"

namespace shoal {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using ::testing::HasSubstr;

// Goes on until it is stopped.
const TrainingRun::Keys kLong{
    {"env_steps", "10000000"}, {"actors", "1"}, {"eval.interval", "5000"}};

bool Learns(const json& view) {
  const json learner = ProcessOf(view, "learner");
  return learner.is_object() && learner.value("updates", 0.0) > 50 &&
         ProcessOf(view, "replay").contains("policy_lag_p50");
}

TEST(Operate, TopShowsEveryProcessUntilTheRunEnds) {
  const TrainingRun run;
  RunningTraining training(run, run.Command(kLong));
  const json view = WaitForView(run, Learns);
  ASSERT_TRUE(view.is_object());
  EXPECT_EQ(view.at("schema"), "shoal-top-1");
  EXPECT_EQ(view.at("run"), "run");
  EXPECT_GT(view.at("env_steps"), 1000);
  EXPECT_GT(view.at("updates"), 0);
  std::set<int> pids;
  for (const char* role : {"coordinator", "replay", "learner", "actor", "eval"}) {
    const json process = ProcessOf(view, role);
    ASSERT_TRUE(process.is_object()) << role;
    EXPECT_EQ(kill(process.at("pid").get<int>(), 0), 0) << role;
    pids.insert(process.at("pid").get<int>());
    for (const char* name : {"rss_mb", "open_files", "cpu_seconds"}) {
      EXPECT_GT(process.at(name), 0) << role << ' ' << name;
    }
  }
  EXPECT_EQ(pids.size(), 5u);
  const json replay = ProcessOf(view, "replay");
  for (const char* name :
       {"queue_depth", "queue_age_seconds", "limiter_blocked_insert_share",
        "limiter_blocked_sample_share", "policy_lag_p99", "data_age_seconds_p90"}) {
    EXPECT_GE(replay.at(name), 0) << name;
  }
  EXPECT_GE(ProcessOf(view, "learner").at("data_age_updates_p50"), replay.at("policy_lag_p50"));
  EXPECT_GE(ProcessOf(view, "actor").at("credit"), 0);

  const ProgramResult table = RunShoal(run, {"top", "--once", "--run", "run"});
  EXPECT_EQ(ExitCode(table), 0) << table.err;
  for (const char* word : {"learner-0", "actor-0", "updates/s", "LAG"}) {
    EXPECT_THAT(table.out, HasSubstr(word));
  }

  kill(training.pid(), SIGINT);
  EXPECT_EQ(training.End(seconds(120)), 0) << training.Output();
  const ProgramResult over = RunShoal(run, {"top", "--run", "run"});
  EXPECT_EQ(ExitCode(over), 1);
  EXPECT_THAT(over.err, HasSubstr("is not running"));
}

}  // namespace
}  // namespace shoal
