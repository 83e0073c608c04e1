// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/model_loading.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::worlds {
namespace {

using testing::HasSubstr;

constexpr const char* kReach = "fetch_reach.xml";

std::string LoadMessage(const std::string& user_file) {
  try {
    LoadModel(kReach, user_file);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// Numbers of the published model as compiled by the same engine.
TEST(FetchReachModel, HasTheMassesAndInertiasOfTheOriginal) {
  const ModelHandle model = LoadModel(kReach, "");
  EXPECT_EQ(model->nq, 15);
  EXPECT_EQ(model->nv, 15);
  EXPECT_EQ(model->nu, 0);
  double mass = 0;
  for (int i = 0; i < model->nbody; ++i) mass += model->body_mass[i];
  // The mocap body's boxes weigh 0.441 kg in the original; here they do too.
  EXPECT_NEAR(mass, 2120.5175, 1e-3);
  const int base = mj_name2id(model.get(), mjOBJ_BODY, "robot0:base_link");
  EXPECT_NEAR(model->body_subtreemass[base], 120.0765, 1e-9);
  EXPECT_NEAR(model->stat.meaninertia, 43.2768, 1e-4);
  const int gripper = mj_name2id(model.get(), mjOBJ_BODY, "robot0:gripper_link");
  EXPECT_NEAR(model->body_invweight0[2 * gripper], 0.0458790, 1e-6);
  EXPECT_NEAR(model->body_invweight0[2 * gripper + 1], 0.7585399, 1e-6);
  EXPECT_NEAR(model->body_invweight0[2 * base], 0.0099526, 1e-6);
}

TEST(FetchReachModel, HasTheViewOfTheOriginal) {
  const ModelHandle model = LoadModel(kReach, "");
  EXPECT_NEAR(model->stat.extent, 2.77437, 1e-9);
  EXPECT_NEAR(model->stat.center[0], 0.387158, 1e-9);
  EXPECT_EQ(model->site_bodyid[0], mj_name2id(model.get(), mjOBJ_BODY, "floor0"));
}

TEST(ModelFingerprint, IsThatOfTheNumbers) {
  const ModelHandle first = LoadModel(kReach, ""), second = LoadModel(kReach, "");
  EXPECT_EQ(ModelFingerprint(*first), ModelFingerprint(*second));
  EXPECT_EQ(ModelFingerprint(*first).size(), 16u);
  double& mass = second->body_mass[3];
  mass = std::nextafter(mass, 1e9);
  EXPECT_NE(ModelFingerprint(*first), ModelFingerprint(*second));
}

TEST(LoadModel, AUsersFileTakesThePlaceOfOurs) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "mine.xml";
  WriteFileAtomically(path, R"(<mujoco><worldbody><body name="only">
      <joint type="free"/><geom size="0.1"/></body></worldbody></mujoco>)");
  EXPECT_GE(mj_name2id(LoadModel(kReach, path.string()).get(), mjOBJ_BODY, "only"), 0);
}

TEST(LoadModel, NamesTheFileAndTheReasonWhenItDoesNotLoad) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "broken.xml";
  WriteFileAtomically(path, "<mujoco><worldbody><geom size='x'/></worldbody></mujoco>");
  EXPECT_THAT(LoadMessage(path.string()), HasSubstr("broken.xml"));
  EXPECT_THAT(LoadMessage(path.string()), HasSubstr("size"));
  EXPECT_THAT(LoadMessage("/nonexistent/model.xml"), HasSubstr("/nonexistent/model.xml"));
}

}  // namespace
}  // namespace shoal::worlds
