// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/reference_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal::worlds {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

const std::string kZero = GoldenPath("reference/fetch_Reach_zero.json");

json Golden() { return json::parse(ReadFile(kZero)); }

// The error of reading this text; empty if there is none.
std::string Complaint(const std::string& text) {
  const TemporaryFolder folder;
  WriteFileAtomically(folder.path() / "broken.json", text);
  try {
    ReadReference(folder.path() / "broken.json");
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("broken.json"));
    return error.what();
  }
  return "";
}

std::string ComplaintAfter(const std::function<void(json&)>& edit) {
  json document = Golden();
  edit(document);
  return Complaint(document.dump());
}

TEST(ReferenceFile, ReadsWhatTheFileHolds) {
  const ReferenceTrajectory trajectory = ReadReference(kZero);
  const json document = Golden();
  EXPECT_EQ(trajectory.environment, "FetchReach-v4");
  EXPECT_EQ(trajectory.sequence, "zero");
  EXPECT_EQ(trajectory.joint_names.size(), 15u);
  ASSERT_EQ(trajectory.steps.size(), 50u);
  const ReferenceStep& step = trajectory.steps[7];
  const json& expected = document["trajectory"][7];
  EXPECT_EQ(step.action, expected["action"].get<std::vector<double>>());
  EXPECT_EQ(step.state.observation, expected["obs"].get<std::vector<double>>());
  EXPECT_EQ(step.state.qvel, expected["qvel"].get<std::vector<double>>());
  EXPECT_EQ(step.distance, expected["distance"].get<double>());
  EXPECT_EQ(trajectory.reset.qpos, document["reset"]["qpos"].get<std::vector<double>>());
}

TEST(ReferenceFile, ReadsTheObjectOfTasksThatHaveOne) {
  const std::string path = GoldenPath("reference/fetch_Push_zero.json");
  const ReferenceTrajectory trajectory = ReadReference(path);
  const json document = json::parse(ReadFile(path));
  EXPECT_EQ(trajectory.task, "FetchPush");
  EXPECT_TRUE(trajectory.has_object);
  EXPECT_EQ(trajectory.object_xy, (document["object_xy"].get<std::array<double, 2>>()));
  EXPECT_EQ(trajectory.table_height, document["height_offset"].get<double>());
  EXPECT_EQ(trajectory.reset.observation.size(), 25u);
  EXPECT_EQ(trajectory.reset.qpos.size(), 22u);
  EXPECT_EQ(trajectory.reset.qvel.size(), 21u);
  EXPECT_EQ(trajectory.reset.contacts, document["reset"]["ncon"].get<int>());
}

TEST(ReferenceFile, NamesAMissingKeyByItsPath) {
  EXPECT_THAT(ComplaintAfter([](json& d) { d.erase("desired_goal"); }),
              HasSubstr("'desired_goal' is missing"));
  EXPECT_THAT(ComplaintAfter([](json& d) { d["reset"].erase("qpos"); }),
              HasSubstr("'reset.qpos' is missing"));
  EXPECT_THAT(ComplaintAfter([](json& d) { d["trajectory"][3].erase("action"); }),
              HasSubstr("'trajectory[3].action' is missing"));
}

TEST(ReferenceFile, NamesAnIllTypedOrWronglySizedKey) {
  EXPECT_THAT(ComplaintAfter([](json& d) { d["sequence"] = 3; }),
              HasSubstr("'sequence' is not a string"));
  EXPECT_THAT(ComplaintAfter([](json& d) { d["trajectory"][2]["distance"] = "far"; }),
              HasSubstr("'trajectory[2].distance' is not a finite number"));
  EXPECT_THAT(ComplaintAfter([](json& d) {
                d["desired_goal"] = {1, 2};
              }),
              HasSubstr("'desired_goal' is not 3 finite numbers"));
  EXPECT_THAT(ComplaintAfter([](json& d) {
                d["desired_goal"] = {1, 2, 3, 4};
              }),
              HasSubstr("'desired_goal' is not 3 finite numbers"));
  EXPECT_THAT(ComplaintAfter([](json& d) { d["reset"]["obs"][4] = nullptr; }),
              HasSubstr("'reset.obs' is not 10 finite numbers"));
  EXPECT_THAT(ComplaintAfter([](json& d) { d["trajectory"][1] = 5; }),
              HasSubstr("trajectory[1] is not an object"));
  EXPECT_THAT(ComplaintAfter([](json& d) { d["trajectory"] = json::array(); }),
              HasSubstr("'trajectory' is not a list of steps"));
  EXPECT_THAT(ComplaintAfter([](json& d) { d["joint_names"] = json::array(); }),
              HasSubstr("'joint_names' is not a list of names"));
}

TEST(ReferenceFile, RefusesActionsOutsideTheirBounds) {
  EXPECT_THAT(ComplaintAfter([](json& d) { d["trajectory"][9]["action"][1] = -1.5; }),
              HasSubstr("'trajectory[9].action' has a component outside [-1, 1]"));
}

TEST(ReferenceFile, RefusesOtherFormatsAndEnvironments) {
  EXPECT_THAT(ComplaintAfter([](json& d) { d["format"] = "vrl-ref-2"; }),
              AllOf(HasSubstr("vrl-ref-2"), HasSubstr("vrl-ref-1")));
  EXPECT_THAT(ComplaintAfter([](json& d) { d["env"] = "FetchThrow-v4"; }),
              AllOf(HasSubstr("FetchThrow-v4"), HasSubstr("cannot be replayed"),
                    HasSubstr("FetchReach-v4"), HasSubstr("FetchPickAndPlace-v4")));
}

TEST(ReferenceFile, RefusesWhatIsNotJson) {
  EXPECT_THAT(Complaint("{\"format\": "), HasSubstr("is not JSON"));
  EXPECT_THAT(Complaint("[1, 2]"), HasSubstr("not an object"));
  EXPECT_THROW(ReadReference("/nonexistent.json"), Error);
}

}  // namespace
}  // namespace shoal::worlds
