// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/run_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

namespace shoal::launch {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Runs that end after a given number of looks with a given status.
class FakeKeeper : public RunKeeper {
 public:
  struct Play {
    int looks = 1;
    ExperimentRunStatus then = ExperimentRunStatus::kFinished;
  };

  StandingReport Standing(const ExperimentRun& run) override {
    if (held_for[run.name] > 0) {
      --held_for[run.name];
      return {ExperimentRunStatus::kRunning, ""};
    }
    return {standings[run.name], standings[run.name] == ExperimentRunStatus::kFailed ? "why" : ""};
  }
  void Start(const ExperimentRun& run, int slot) override {
    EXPECT_FALSE(running_.contains(slot)) << "the slot is taken";
    running_[slot] = {run.name, plays[run.name].looks};
    started.push_back(run.name);
    most_at_once = std::max(most_at_once, running_.size());
  }
  bool Ended(int slot) override {
    auto& [name, looks] = running_.at(slot);
    if (--looks > 0 && !stopped) return false;
    standings[name] = stopped ? ExperimentRunStatus::kInterrupted : plays[name].then;
    running_.erase(slot);
    return true;
  }
  void Stop() override {
    ++stop_calls;
    stopped = true;
  }

  std::map<std::string, ExperimentRunStatus> standings;  // kMissing where not set
  std::map<std::string, Play> plays;
  std::map<std::string, int> held_for;  // looks for which another process holds it
  std::vector<std::string> started;
  size_t most_at_once = 0;
  int stop_calls = 0;
  bool stopped = false;

 private:
  std::map<int, std::pair<std::string, int>> running_;
};

class RunQueueTest : public testing::Test {
 protected:
  void Do(const std::vector<std::string>& names, const QueueTerms& terms = {}) {
    std::vector<ExperimentRun> runs;
    for (const std::string& name : names) runs.push_back({.name = name});
    DoRuns(runs, terms, keeper_,
           {.stops = [this] { return waits_ >= stop_at_ ? stops_ : 0; },
            .wait = [this] { ASSERT_LT(++waits_, 1000) << "it never ends"; },
            .say = [this](const std::string& line) { said_.push_back(line); },
            .done =
                [this](const ExperimentRun& run, const StandingReport& report) {
                  done_.push_back(run.name + " " + ToString(report.standing));
                }});
  }

  FakeKeeper keeper_;
  std::vector<std::string> said_, done_;
  int waits_ = 0, stop_at_ = 100'000, stops_ = 1;
};

TEST_F(RunQueueTest, WhatIsFinishedIsSkippedAndTheOthersAreDoneInOrder) {
  keeper_.standings = {{"a", ExperimentRunStatus::kFinished},
                       {"c", ExperimentRunStatus::kInterrupted}};
  Do({"a", "b", "c"});
  EXPECT_THAT(keeper_.started, ElementsAre("b", "c"));
  EXPECT_THAT(done_, ElementsAre("a finished", "b finished", "c finished"));
  EXPECT_THAT(said_, Contains("[2/3] b: begins"));
  EXPECT_THAT(said_, Contains("[3/3] c: goes on"));
}

TEST_F(RunQueueTest, AFailedRunIsSaidAndTheNextOneBegins) {
  keeper_.plays["a"].then = ExperimentRunStatus::kFailed;
  Do({"a", "b"});
  EXPECT_THAT(done_, ElementsAre("a failed", "b finished"));
  EXPECT_THAT(said_, Contains("[1/2] a: failed: why; going on with the next"));
}

TEST_F(RunQueueTest, WhatFailedBeforeIsTriedAgainOnlyWhenAsked) {
  keeper_.standings = {{"a", ExperimentRunStatus::kFailed}};
  Do({"a", "b"});
  EXPECT_THAT(keeper_.started, ElementsAre("b"));
  EXPECT_THAT(said_, Contains(HasSubstr("--retry-failed")));
  Do({"a", "b"}, {.retry_failed = true});
  EXPECT_THAT(keeper_.started, ElementsAre("b", "a"));
}

TEST_F(RunQueueTest, AsManyAtOnceAsJobs) {
  for (const char* name : {"a", "b", "c", "d"}) keeper_.plays[name].looks = 3;
  Do({"a", "b", "c", "d"}, {.jobs = 2});
  EXPECT_EQ(keeper_.most_at_once, 2u);
  EXPECT_EQ(done_.size(), 4u);
}

TEST_F(RunQueueTest, AStopIsPassedOnAndNothingFurtherBegins) {
  keeper_.plays["a"].looks = 50;
  stop_at_ = 5;
  Do({"a", "b"});
  EXPECT_THAT(keeper_.started, ElementsAre("a"));
  EXPECT_EQ(keeper_.stop_calls, 1);
  EXPECT_THAT(done_, ElementsAre("a interrupted"));
}

TEST_F(RunQueueTest, ASecondStopIsPassedOnToo) {
  keeper_.plays["a"].looks = 50;
  stop_at_ = 5;
  stops_ = 2;
  Do({"a"});
  EXPECT_EQ(keeper_.stop_calls, 2);
}

TEST_F(RunQueueTest, ARunThatSomebodyElseHoldsIsPutOffNotLeftOut) {
  keeper_.held_for["a"] = 20;
  Do({"a", "b"});
  EXPECT_THAT(keeper_.started, ElementsAre("b", "a"));
  EXPECT_EQ(
      std::ranges::count(said_, "[1/2] a: another process still holds it; waiting for its end"), 1);
}

TEST_F(RunQueueTest, AStopEndsTheWaitForAHeldRun) {
  keeper_.held_for["a"] = 100'000;
  stop_at_ = 5;
  Do({"a"});
  EXPECT_THAT(done_, IsEmpty());
}

}  // namespace
}  // namespace shoal::launch
