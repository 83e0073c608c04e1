// SPDX-License-Identifier: Apache-2.0
// MJCF files of users in place of Shoal's own.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "actor/worlds/fetch_world.h"
#include "actor/worlds/site_motion.h"
#include "actor/worlds/world_registry.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal::worlds {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kObject = R"(<body name="object0" pos="0 0 2">
    <joint name="object0:joint" type="free"/><geom size="0.02"/><site name="object0"/></body>)";
constexpr const char* kMotors = R"(<actuator>
    <position joint="robot0:l_gripper_finger_joint"/>
    <position joint="robot0:r_gripper_finger_joint"/></actuator>)";

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// The least that each task can work with.
std::string LeastModel(const std::string& task) {
  std::string text = ReadFile(SourcePath("tests/actor/worlds/other_reach.xml"));
  if (task == "FetchReach") return text;
  text = Replaced(text, "</worldbody>", std::string(kObject) + "</worldbody>");
  if (task == "FetchPickAndPlace")
    text = Replaced(text, "</mujoco>", kMotors + std::string("</mujoco>"));
  return text;
}

std::string Complaint(const std::string& task, const std::string& text) {
  const TemporaryFolder folder;
  WriteFileAtomically(folder.path() / "mine.xml", text);
  try {
    MakeWorld(task, {.model = (folder.path() / "mine.xml").string()});
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("mine.xml"));
    return error.what();
  }
  return "";
}

class UserModel : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Fetch, UserModel,
                         testing::Values("FetchReach", "FetchPush", "FetchSlide",
                                         "FetchPickAndPlace"));

TEST_P(UserModel, TheNamedElementsAreEnough) {
  EXPECT_EQ(Complaint(GetParam(), LeastModel(GetParam())), "");
}

TEST_P(UserModel, WhatIsLackingIsNamed) {
  const std::string task = GetParam(), model = LeastModel(task);
  for (const auto& [kind, name] :
       std::vector<std::pair<std::string, std::string>>{{"site", "target0"},
                                                        {"site", "robot0:grip"},
                                                        {"joint", "robot0:slide0"},
                                                        {"joint", "robot0:slide2"}}) {
    const std::string text = Replaced(model, "name=\"" + name + "\"", "");
    EXPECT_THAT(Complaint(task, text), HasSubstr(fmt::format("has no {} named '{}'", kind, name)));
  }
  const std::string still = Replaced(model, " mocap=\"true\"", "");
  EXPECT_THAT(Complaint(task, still), HasSubstr("'robot0:mocap' is not a mocap body"));
  const std::string loose =
      Replaced(model, R"(<weld body1="robot0:mocap" body2="robot0:gripper_link"/>)", "");
  EXPECT_THAT(Complaint(task, loose),
              AllOf(HasSubstr("no weld"), HasSubstr("'robot0:gripper_link'")));
}

TEST_P(UserModel, MayBeHeldAsInMujoco3) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "mine.xml";
  WriteFileAtomically(path, LeastModel(GetParam()));
  const auto world = MakeWorld(GetParam(), {.model = path.string(), .physics = "mujoco3"});
  const auto literal = MakeWorld(GetParam(), {.model = path.string(), .physics = "mujoco2"});
  EXPECT_NE(world->fingerprint(), literal->fingerprint());
}

// The engine ignores site_pos for a site at its body's origin. Pictures would then show the target
// at the same place for every goal.
TEST_P(UserModel, ATargetAtItsBodysOriginGoesWhereTheGoalIs) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "mine.xml";
  WriteFileAtomically(path, LeastModel(GetParam()));
  const auto world = MakeWorld(GetParam(), {.model = path.string()});
  auto& fetch = dynamic_cast<FetchWorld&>(*world);
  for (const std::array<double, 3>& goal : {std::array{1.3, 0.7, 0.5}, std::array{1.4, 0.6, 0.9}}) {
    fetch.ResetTo(goal, {1.3, 0.7});
    EXPECT_EQ(PositionOfSite(fetch, fetch.SiteId("target0")), goal);
  }
}

TEST(UserModelFile, TheObjectsJointMustBeFree) {
  const std::string text = Replaced(LeastModel("FetchPush"), R"(name="object0:joint" type="free")",
                                    R"(name="object0:joint" type="slide")");
  EXPECT_THAT(Complaint("FetchPush", text), HasSubstr("'object0:joint' is not a free joint"));
}

TEST(UserModelFile, AnObjectTaskNeedsTheObject) {
  const std::string text = LeastModel("FetchReach");
  EXPECT_THAT(Complaint("FetchSlide", text), HasSubstr("has no site named 'object0'"));
}

TEST(UserModelFile, PickAndPlaceNeedsMotorsForBothFingers) {
  EXPECT_THAT(Complaint("FetchPickAndPlace", LeastModel("FetchPush")), HasSubstr("no actuator"));
  const std::string one = Replaced(LeastModel("FetchPickAndPlace"),
                                   R"(<position joint="robot0:r_gripper_finger_joint"/>)", "");
  EXPECT_THAT(Complaint("FetchPickAndPlace", one), HasSubstr("no actuator"));
}

TEST(UserModelFile, AnActuatorOfSomethingElseIsRefused) {
  const std::string text = Replaced(
      LeastModel("FetchPush"), "</mujoco>",
      R"(<actuator><general joint="object0:joint" gear="1 0 0 0 0 0"/></actuator></mujoco>)");
  EXPECT_THAT(Complaint("FetchPush", text), HasSubstr("actuator 0 does not drive"));
}

TEST(UserModelFile, IncludesAreFoundBesideTheFileInBothPhysics) {
  const TemporaryFolder folder;
  WriteFileAtomically(folder.path() / "part.xml", LeastModel("FetchReach"));
  WriteFileAtomically(folder.path() / "mine.xml", R"(<mujoco><include file="part.xml"/></mujoco>)");
  for (const char* physics : {"mujoco2", "mujoco3"}) {
    EXPECT_NO_THROW(MakeWorld(
        "FetchReach", {.model = (folder.path() / "mine.xml").string(), .physics = physics}));
  }
}

TEST(UserModelFile, PhysicsThatDoNotExistAreRefused) {
  try {
    MakeWorld("FetchPush", {.model = "", .physics = "mujoco4"});
    FAIL() << "made a world with physics that do not exist";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_THAT(error.what(), AllOf(HasSubstr("mujoco4"), HasSubstr("mujoco2 or mujoco3")));
  }
}

}  // namespace
}  // namespace shoal::worlds
