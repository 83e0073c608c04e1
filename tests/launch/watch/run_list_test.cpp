// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/run_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/files.h"
#include "common/config/run_files.h"
#include "common/dds/bus.h"
#include "launch/record/run_folder.h"
#include "launch/record/run_meta.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/without_rights.h"

namespace shoal::launch {
namespace {

using ::testing::HasSubstr;

class RunListTest : public ::testing::Test {
 protected:
  // A run that ended with `exit`; it is held while the result lives.
  RunFolder Begin(const std::string& name, const std::string& exit) const {
    RunFolder run = RunFolder::Create(dir_.path(), name, false);
    WriteFileAtomically(run.path() / "config.json", "{}");
    if (exit.empty()) return run;
    Config config;
    config.run_name = name;
    RunMeta meta;
    meta.started = "2026-01-31T12:00:00Z";
    meta.env_steps = 1234;
    meta.updates = 99;
    meta.wall_seconds = 61;
    meta.exit = exit;
    if (exit != "running") meta.finished = "2026-01-31T12:01:01Z";
    meta.best = EvaluationPoint{.success = 0.5};
    if (exit == "failed") meta.error = "the disk is full";
    WriteRunMeta(run.path(), config, meta);
    return run;
  }
  RunListing Only(const std::string& name) const {
    for (const RunListing& run : ListRunStatus(dir_.path())) {
      if (run.name == name) return run;
    }
    ADD_FAILURE() << name << " is not listed";
    return {};
  }
  const TemporaryFolder dir_;
};

TEST_F(RunListTest, StatusIsOfTheLockFirstAndOfTheRecordedEndThen) {
  for (const auto& [exit, status] :
       std::vector<std::pair<std::string, RunStatus>>{{"target", RunStatus::kFinished},
                                                      {"budget", RunStatus::kFinished},
                                                      {"interrupted", RunStatus::kInterrupted},
                                                      {"failed", RunStatus::kFailed},
                                                      {"running", RunStatus::kDead},
                                                      {"", RunStatus::kDead}}) {
    const std::string name = exit.empty() ? "fresh" : exit;
    {
      const RunFolder held = Begin(name, exit);
      EXPECT_EQ(Only(name).status, RunStatus::kRunning) << exit;
    }
    EXPECT_EQ(Only(name).status, status) << exit;
  }
}

// That it would end is recorded before its last evaluation.
TEST_F(RunListTest, ARunWhoseCoordinatorDiedAtItsEndIsDead) {
  RunMeta meta;
  meta.exit = "budget";
  WriteRunMeta(Begin("a", "").path(), Config{}, meta);
  EXPECT_EQ(Only("a").status, RunStatus::kDead);
  meta.finished = "2026-01-31T12:01:01Z";
  WriteRunMeta(dir_.path() / "a", Config{}, meta);
  EXPECT_EQ(Only("a").status, RunStatus::kFinished);
}

TEST_F(RunListTest, ARunningRunSaysWhereItIsToBeReached) {
  const auto peer = [&](const RunListing& run) {
    return nlohmann::json::parse(RunListJson(dir_.path(), {run})).at("runs").at(0).at("peer");
  };
  {
    const RunFolder held = Begin("a", "running");
    EXPECT_TRUE(peer(Only("a")).is_null()) << "not yet";
    const ClusterAddress address{.domain = 4, .tag = "a", .host = "10.0.0.7"};
    WriteClusterAddress(held.path(), address);
    EXPECT_EQ(peer(Only("a")), "10.0.0.7:" + std::to_string(dds::OperatePort(address)));
  }
  EXPECT_TRUE(peer(Only("a")).is_null()) << "the process has ended";
}

TEST_F(RunListTest, ARunOfATaskWithoutSuccessIsListedByItsReturn) {
  RunMeta meta;
  meta.exit = "budget";
  meta.best = EvaluationPoint{.success = std::nullopt, .mean_return = 861.25};
  meta.final_return = 863.9;
  meta.finished = "2026-01-31T12:01:01Z";
  WriteRunMeta(Begin("hopper", "").path(), Config{}, meta);
  const RunListing run = Only("hopper");
  EXPECT_EQ(run.status, RunStatus::kFinished) << run.problem;
  EXPECT_EQ(run.best.success, std::nullopt);
  EXPECT_THAT(FormatRunList({run})[1], HasSubstr("return 861.2  return 863.9"));
  const auto json = nlohmann::json::parse(RunListJson(dir_.path(), {run})).at("runs").at(0);
  EXPECT_TRUE(json.at("best_success_rate").is_null());
  EXPECT_EQ(json.at("best_return_mean"), 861.25);
}

TEST_F(RunListTest, ABrokenRunIsListedAndHidesNoOther) {
  Begin("a", "target");
  Begin("b", "budget");
  WriteFileAtomically(dir_.path() / "b" / "meta.json", "{ broken");
  Begin("c", "budget");
  WriteFileAtomically(dir_.path() / "c" / "meta.json", "{}");
  MakeFolders(dir_.path() / "not-a-run");
  ASSERT_EQ(ListRunStatus(dir_.path()).size(), 3u);
  EXPECT_EQ(Only("b").status, RunStatus::kUnreadable);
  EXPECT_THAT(Only("b").problem, HasSubstr("meta.json"));
  EXPECT_EQ(Only("c").status, RunStatus::kUnreadable);
  EXPECT_EQ(Only("a").status, RunStatus::kFinished);
}

TEST_F(RunListTest, AnotherUsersRunIsListedAsUnreadable) {
  Begin("mine", "target");
  Begin("theirs", "target");
  const WithoutRights closed(dir_.path() / "theirs");
  const auto runs = ListRunStatus(dir_.path());
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(Only("theirs").status, RunStatus::kUnreadable);
  EXPECT_EQ(Only("theirs").problem, "permission denied");
}

TEST_F(RunListTest, AFolderThatMayNotBeReadIsNoEmptyOne) {
  Begin("mine", "target");
  const WithoutRights closed(dir_.path());
  EXPECT_THAT(ErrorMessage(1, [&] { ListRunStatus(dir_.path()); }), HasSubstr("Permission denied"));
}

TEST_F(RunListTest, TableAndJsonSayTheSame) {
  Begin("slow", "failed");
  const auto runs = ListRunStatus(dir_.path());
  const auto lines = FormatRunList(runs);
  ASSERT_EQ(lines.size(), 3u);
  for (const char* word : {"slow", "failed", "1234", "99", "50 %", "01:01", "2026-01-31 12:00"}) {
    EXPECT_THAT(lines[1], HasSubstr(word));
  }
  EXPECT_EQ(lines[2], "  the disk is full");
  const auto json = nlohmann::json::parse(RunListJson(dir_.path(), runs));
  EXPECT_EQ(json.at("schema"), "shoal-runs-1");
  const auto& run = json.at("runs").at(0);
  EXPECT_EQ(run.at("status"), "failed");
  EXPECT_EQ(run.at("env_steps"), 1234);
  EXPECT_EQ(run.at("best_success_rate"), 0.5);
  EXPECT_TRUE(run.at("final_success_rate").is_null());
  EXPECT_EQ(run.at("disk_bytes"), runs[0].size->total);
  EXPECT_EQ(run.at("replay_bytes"), 0);
}

TEST_F(RunListTest, EachRunIsListedWithItsSize) {
  Begin("a", "target");
  WriteFileAtomically(dir_.path() / "a" / "replay.ring", std::string(3'000'000, 'x'));
  const auto runs = ListRunStatus(dir_.path());
  ASSERT_TRUE(runs.at(0).size);
  EXPECT_GE(runs[0].size->replay, 3'000'000u);
  EXPECT_GT(runs[0].size->total, runs[0].size->replay);
  const auto lines = FormatRunList(runs);
  EXPECT_THAT(lines[0], HasSubstr("  SIZE  "));
  EXPECT_THAT(lines[1], HasSubstr(" 3.0 MB  "));
}

TEST_F(RunListTest, AFolderThatIsNotThereHoldsNoRuns) {
  EXPECT_TRUE(ListRunStatus(dir_.path() / "absent").empty());
}

TEST_F(RunListTest, ANameThatIsNotUtf8IsReplacedInJson) {
  Begin("l\xe4uft", "target");
  const auto runs = ListRunStatus(dir_.path());
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(nlohmann::json::parse(RunListJson("runs", runs)).at("runs")[0].at("name"),
            "l\xef\xbf\xbduft");
}

}  // namespace
}  // namespace shoal::launch
