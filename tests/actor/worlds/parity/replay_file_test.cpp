// SPDX-License-Identifier: Apache-2.0
#include "tests/actor/worlds/parity/replay_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/actor/worlds/parity/cross_version_file.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal::worlds {
namespace {

using testing::HasSubstr;

const std::string kFolder = GoldenPath("reference/");
const std::string kCrossVersion = kFolder + "fetch_crossversion_grip.json";

std::string Complaint(const std::filesystem::path& path, const ReplayOptions& options = {}) {
  try {
    ReplayFile(path, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// The file with one task and one sequence, beside one trajectory.
std::filesystem::path Small(const TemporaryFolder& folder, const std::string& sequence) {
  nlohmann::json document = nlohmann::json::parse(ReadFile(kCrossVersion));
  nlohmann::json& tasks = document["versions"]["3.3.8"];
  nlohmann::json reach = tasks["FetchReach"];
  reach["sequences"] = {{sequence, tasks["FetchReach"]["sequences"][sequence]}};
  tasks = {{"FetchReach", reach}};
  WriteFileAtomically(folder.path() / "grip.json", document.dump());
  std::filesystem::copy(kFolder + "fetch_Reach_zero.json", folder.path() / "fetch_Reach_zero.json");
  return folder.path() / "grip.json";
}

TEST(ReplayFile, ATrajectoryGivesItsOneReport) {
  const auto reports = ReplayFile(kFolder + "fetch_Reach_zero.json");
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports[0].sequence, "zero");
  EXPECT_EQ(reports[0].physics, "mujoco2");
  EXPECT_TRUE(reports[0].passed);
}

TEST(ReplayFile, TheSoftenedWeldFollowsMujoco3InEveryTask) {
  std::map<std::string, int> sequences;
  for (const ReplayReport& report : ReplayFile(kCrossVersion)) {
    EXPECT_TRUE(report.passed) << ToText(report);
    EXPECT_EQ(report.physics, "mujoco3");
    EXPECT_EQ(report.steps, 50);
    EXPECT_LE(report.tolerance, report.sequence == "const_y" ? 1.5e-2 : 3e-3);
    EXPECT_TRUE(report.sequence != "const_x" || report.tolerance == 1e-3);
    ++sequences[report.environment];
  }
  EXPECT_EQ(sequences.size(), 4u);
  for (const auto& [environment, count] : sequences) EXPECT_GE(count, 5) << environment;
}

TEST(ReplayFile, TheLiteralWeldDoesNotFollowMujoco3) {
  const TemporaryFolder folder;
  const auto path = Small(folder, "const_x");
  EXPECT_TRUE(ReplayFile(path).at(0).passed);
  const auto reports = ReplayFile(path, {.model = "", .physics = "mujoco2"});
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_FALSE(reports[0].passed);
  EXPECT_EQ(reports[0].physics, "mujoco2");
}

TEST(ReplayFile, SequencesWhoseActionsNothingTellsAreLeftOutAndSaid) {
  const TemporaryFolder folder;
  const auto path = Small(folder, "random_hold5");
  const CrossVersionFile file = ReadCrossVersions(path, "3.3.8");
  EXPECT_TRUE(file.sequences.empty());
  EXPECT_EQ(file.left_out, std::vector<std::string>{"FetchReach random_hold5"});
}

// `shoal-parity fetch_Reach_*.json` meets them beside the trajectories.
TEST(ReplayFile, PicturesAreSkippedAndAnUnknownFormatIsNamed) {
  EXPECT_TRUE(ReplayFile(kFolder + "fetch_Reach_frames_84.json").empty());
  const TemporaryFolder folder;
  WriteFileAtomically(folder.path() / "later.json", R"({"format": "vrl-ref-9"})");
  EXPECT_THAT(Complaint(folder.path() / "later.json"),
              testing::AllOf(HasSubstr("vrl-ref-9"), HasSubstr("vrl-ref-1")));
}

TEST(ReplayFile, NamesWhatIsWrong) {
  const TemporaryFolder folder;
  const auto path = Small(folder, "const_x");
  nlohmann::json document = nlohmann::json::parse(ReadFile(path));
  document["versions"]["3.3.8"]["FetchReach"]["sequences"]["const_x"][3] = {1, 2};
  WriteFileAtomically(folder.path() / "short.json", document.dump());
  EXPECT_THAT(Complaint(folder.path() / "short.json"),
              HasSubstr("'versions.3.3.8.FetchReach.sequences.const_x' is not a list"));
  std::filesystem::remove(folder.path() / "fetch_Reach_zero.json");
  EXPECT_THAT(Complaint(path), HasSubstr("FetchReach"));
  EXPECT_THAT(Complaint(kCrossVersion, {.model = "some.xml", .physics = ""}),
              HasSubstr("one model file"));
  EXPECT_THAT(Complaint(kFolder + "fetch_Reach_zero.json", {.model = "", .physics = "mujoco4"}),
              HasSubstr("mujoco4"));
}

}  // namespace
}  // namespace shoal::worlds
