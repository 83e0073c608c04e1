// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/merged_summary.h"

#include <gmock/gmock.h>

#include "common/base/files.h"
#include "launch/tools/experiment/stored_summary.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;

ordered_json RunRow(int seed, const char* status, double return_mean = 0) {
  const bool done = std::string(status) == "finished";
  return {{"seed", seed},
          {"status", status},
          {"n_to_target", nullptr},
          {"success", nullptr},
          {"episodes", done ? ordered_json(10) : ordered_json()},
          {"return_mean", done ? ordered_json(return_mean) : ordered_json()},
          {"final_distance_mean", nullptr}};
}

// A summary of two arms with the rows of the first one.
ordered_json SummaryWith(const std::vector<ordered_json>& rows) {
  return {{"schema", "shoal-experiment-1"},
          {"name", "tasks"},
          {"base", "state"},
          {"target_success", 0.9},
          {"n_to_target_rule", "together"},
          {"commit", "abc"},
          {"arms",
           {{{"name", "a"}, {"overrides", {{"task", "x"}}}, {"runs", rows}},
            {{"name", "b"},
             {"overrides", {{"task", "y"}}},
             {"runs", std::vector{RunRow(0, "missing")}}}}},
          {"ratios", ordered_json::array()}};
}

class MergedSummaryTest : public testing::Test {
 protected:
  ordered_json Merged(const std::vector<ordered_json>& summaries) const {
    std::vector<std::filesystem::path> files;
    for (const ordered_json& summary : summaries) {
      files.push_back(folder_.path() / (std::to_string(files.size()) + ".json"));
      WriteFileAtomically(files.back(), summary.dump());
    }
    return ReadMergedSummary(files);
  }

  const TemporaryFolder folder_;
};

TEST_F(MergedSummaryTest, HasEachRunWhereItGotFurthestAndTheAggregatesOfAll) {
  const ordered_json finished = RunRow(1, "finished", 20), failed = RunRow(2, "failed"),
                     begun = RunRow(3, "interrupted"), first = RunRow(0, "finished", 10);
  const ordered_json one = SummaryWith({first, RunRow(1, "interrupted"), RunRow(2, "missing")});
  const ordered_json other = SummaryWith({begun, RunRow(0, "missing"), finished, failed});
  for (const auto& both : {std::vector{one, other}, std::vector{other, one}}) {
    const ordered_json arm = Merged(both).at("arms").at(0);
    EXPECT_EQ(arm.at("runs"), ordered_json({first, finished, failed, begun}));
    EXPECT_EQ(arm.at("return").at("mean"), 15);
    EXPECT_EQ(arm.at("return").at("seeds"), 2);
    EXPECT_EQ(arm.at("return").at("failed"), 1);
  }
}

TEST_F(MergedSummaryTest, OfOneFileOrOfTheSameRowsTwiceIsThatSummary) {
  const ordered_json summary = SummaryWith({RunRow(0, "finished", 10), RunRow(1, "failed")});
  const ordered_json alone = Merged({summary});
  EXPECT_EQ(alone.at("arms").at(0).at("return").at("mean"), 10);
  EXPECT_EQ(Merged({summary, summary}), alone);
}

TEST_F(MergedSummaryTest, RefusesToChooseBetweenResults) {
  const ordered_json one = SummaryWith({RunRow(4, "finished", 10)});
  for (const ordered_json& row : {RunRow(4, "finished", 11), RunRow(4, "failed")}) {
    const std::string message = UsageMessage([&] { Merged({one, SummaryWith({row})}); });
    EXPECT_THAT(message, HasSubstr("1.json': seed 4 of arm a has ended with other results"));
  }
}

TEST_F(MergedSummaryTest, RefusesFilesOfDifferentExperiments) {
  const ordered_json one = SummaryWith({RunRow(0, "missing")});
  ordered_json named = one, based = one, set = one, fewer = one;
  named["name"] = "others";
  based["base"] = "pixels";
  set.at("arms").at(1).at("overrides")["task"] = "z";
  fewer.at("arms").erase(1);
  for (const ordered_json& other : {named, based, set, fewer}) {
    EXPECT_THAT(UsageMessage([&] {
                  Merged({one, other});
                }),
                HasSubstr("1.json': expected the name, base and arms of "))
        << other;
  }
}

}  // namespace
}  // namespace shoal::launch
