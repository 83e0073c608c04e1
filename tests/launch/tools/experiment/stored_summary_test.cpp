// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/stored_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "common/base/files.h"
#include "tests/support/error_message.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;
using ::testing::HasSubstr;

ordered_json Row(int seed, const char* status, ordered_json success, ordered_json n_to_target) {
  const bool done = std::string(status) == "finished";
  return {{"run", "x"},
          {"seed", seed},
          {"status", status},
          {"n_to_target", std::move(n_to_target)},
          {"success", std::move(success)},
          {"episodes", done ? ordered_json(400) : ordered_json()},
          {"return_mean", done ? ordered_json(-1.0) : ordered_json()},
          {"final_distance_mean", nullptr}};
}

// A summary by an older build, which pooled the episodes of all seeds.
ordered_json Old() {
  return {{"schema", "shoal-experiment-1"},
          {"name", "old"},
          {"question", "Why?"},
          {"target_success", 0.9},
          {"commit", "abc"},
          {"arms",
           {{{"name", "a"},
             {"runs",
              {Row(1, "finished", 0.9975, 100), Row(2, "finished", 0.96, 100),
               Row(3, "finished", 0.9375, 100)}},
             {"success", {{"pooled", 0.965}, {"wilson95", {0.953, 0.974}}}}},
            {{"name", "b"},
             {"runs",
              {Row(1, "finished", 0.99, 150), Row(2, "failed", nullptr, nullptr),
               Row(3, "missing", nullptr, nullptr)}},
             {"success", {{"pooled", 0.99}}}}}},
          {"ratios", ordered_json::array({{{"name", "b/a"}, {"pairs", ordered_json::array()}}})}};
}

class StoredSummaryTest : public testing::Test {
 protected:
  ordered_json Read(const ordered_json& object) const {
    WriteFileAtomically(file_, object.dump());
    return ReadStoredSummary(file_);
  }

  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "summary.json";
};

TEST_F(StoredSummaryTest, HasIntervalsOverSeedsFromItsOwnRows) {
  const ordered_json summary = Read(Old());
  const auto& a = summary.at("arms").at(0);
  EXPECT_NEAR(a.at("success").at("ci95").at(0).get<double>(), 0.889704, 1e-6);
  EXPECT_TRUE(a.at("success").at("wilson95").is_null());
  EXPECT_EQ(a.at("return").at("seeds"), 3);
  EXPECT_EQ(summary.at("arms").at(1).at("success").at("failed"), 1);
  EXPECT_EQ(a.at("runs"), Old().at("arms").at(0).at("runs")) << "rows stay as they are";
  EXPECT_EQ(summary.at("commit"), "abc");
}

TEST_F(StoredSummaryTest, AFailedSeedCountsInTheRatios) {
  const ordered_json summary = Read(Old());
  const auto& ratio = summary.at("ratios").at(0);
  EXPECT_EQ(ratio.at("pairs").size(), 2u) << "not the missing one";
  EXPECT_EQ(ratio.at("not_reached"), 1);
}

TEST_F(StoredSummaryTest, SaysByWhichRuleTheTargetWasReached) {
  EXPECT_EQ(Read(Old()).at("n_to_target_rule"), "each");
  ordered_json newer = Old();
  newer["n_to_target_rule"] = "together";
  EXPECT_EQ(Read(newer).at("n_to_target_rule"), "together");
}

TEST_F(StoredSummaryTest, IsItsOwnFixedPoint) {
  const ordered_json once = Read(Old());
  EXPECT_EQ(Read(once), once);
}

// Made with `shoal experiment summary FILE --json`. Generate them again after a change of the
// statistics.
TEST(CommittedSummaries, HaveTheAggregatesOfTheirRows) {
  int files = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(SourcePath("docs/results/experiments"))) {
    const std::string name = entry.path().filename();
    if (name.find("summary") == std::string::npos || !name.ends_with(".json")) continue;
    ++files;
    EXPECT_EQ(ReadFile(entry.path()), ReadStoredSummary(entry.path()).dump(2) + "\n")
        << entry.path();
  }
  EXPECT_GE(files, 20);
}

TEST_F(StoredSummaryTest, TheTextIsThatOfTheRows) {
  const std::string text = StoredSummaryText(Read(Old()));
  EXPECT_THAT(text, HasSubstr("Why?"));
  EXPECT_THAT(text, HasSubstr("96.5 % [89.0, 100.0] (3 seeds, 1158/1200)"));
  EXPECT_THAT(text, HasSubstr("1/3, 1 failed"));
  EXPECT_THAT(text, HasSubstr("env steps to 90 %, b / a: no median: 1 of 2 pairs did not reach the "
                              "target (seed 1: 1.50, seed 2: not reached by b)"));
}

TEST_F(StoredSummaryTest, RefusesWhatIsNoSummary) {
  EXPECT_THAT(UsageMessage([&] {
                Read({{"schema", "shoal-eval-1"}});
              }),
              HasSubstr("summary.json': expected a summary of schema shoal-experiment-1"));
  ordered_json broken = Old();
  broken.at("arms").at(0).erase("runs");
  EXPECT_THROW(Read(broken), Error);
}

}  // namespace
}  // namespace shoal::launch
