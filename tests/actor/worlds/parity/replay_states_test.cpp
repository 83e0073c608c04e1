// SPDX-License-Identifier: Apache-2.0
#include "tests/actor/worlds/parity/replay_states.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/actor/worlds/parity/replay_file.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal::worlds {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string Golden(const std::string& name) { return GoldenPath("reference/" + name + ".json"); }

class StateParity : public testing::TestWithParam<const char*> {};

TEST_P(StateParity, OurPhysicsFollowsTheOriginalsWithinItsTolerance) {
  const ReplayReport report = ReplayFile(Golden(GetParam())).at(0);
  EXPECT_EQ(report.contact_mismatches, 0);
  EXPECT_EQ(report.steps, 50);
  EXPECT_TRUE(report.passed) << ToText(report);
  EXPECT_EQ(report.deviations.size(), 4u);
}

INSTANTIATE_TEST_SUITE_P(Tasks, StateParity,
                         testing::Values("hopper_gymnasium_zero", "hopper_gymnasium_random0",
                                         "hopper_gymnasium_const_a2", "hopper_gymnasium_const_mix",
                                         "hopper_custom_source_random_hold5",
                                         "hopper_custom_target_const_a1",
                                         "dmc_cartpole_swingup_random0", "dmc_reacher_easy_random0",
                                         "dmc_cheetah_run_random0", "dmc_ball_in_cup_catch_random0",
                                         "dmc_finger_spin_random0", "dmc_walker_walk_random0"));

ReplayReport ReplayEdited(const std::string& name, const std::function<void(json&)>& edit) {
  json document = json::parse(ReadFile(Golden(name)));
  edit(document);
  const TemporaryFolder folder;
  WriteFileAtomically(folder.path() / "edited.json", document.dump());
  return ReplayFile(folder.path() / "edited.json").at(0);
}

std::string Complaint(const std::string& name, const std::function<void(json&)>& edit) {
  try {
    ReplayEdited(name, edit);
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("edited.json"));
    return error.what();
  }
  return "";
}

TEST(ReplayStates, ANumberBeyondTheToleranceFailsAndIsNamedWithItsStep) {
  const ReplayReport report = ReplayEdited("dmc_walker_walk_random0", [](json& d) {
    d["trajectory"][29]["reward"] = d["trajectory"][29]["reward"].get<double>() + 1e-6;
  });
  EXPECT_FALSE(report.passed);
  for (const Deviation& deviation : report.deviations) {
    EXPECT_EQ(deviation.Passed(), deviation.quantity != "reward") << deviation.quantity;
    if (deviation.quantity == "reward") {
      EXPECT_EQ(deviation.at_step, 30);
    }
  }
}

TEST(ReplayStates, AnotherActionIsNoticed) {
  EXPECT_FALSE(ReplayEdited("hopper_gymnasium_random0", [](json& d) {
                 d["trajectory"][10]["action"] = {0.125, 0, 0};
               }).passed);
  EXPECT_FALSE(ReplayEdited("dmc_finger_spin_random0", [](json& d) {
                 d["trajectory"][10]["action"] = {0.125, 0};
               }).passed);
}

TEST(ReplayStates, TheVariantsOfHopperDiffer) {
  for (const char* variant : {"gymnasium_source", "custom_target", "custom_source"}) {
    EXPECT_FALSE(
        ReplayEdited("hopper_gymnasium_random0", [&](json& d) { d["variant"] = variant; }).passed)
        << variant;
  }
}

TEST(ReplayStates, AnEpisodeThatEndsElsewhereIsCounted) {
  const ReplayReport report = ReplayEdited("hopper_gymnasium_random0", [](json& d) {
    d["trajectory"][4]["healthy"] = 1 - d["trajectory"][4]["healthy"].get<int>();
  });
  EXPECT_EQ(report.termination_mismatches, 1);
  EXPECT_FALSE(report.passed);
}

TEST(ReplayStates, MistakesInAFileAreNamed) {
  EXPECT_THAT(Complaint("hopper_gymnasium_zero", [](json& d) { d["variant"] = "wooden"; }),
              testing::AllOf(HasSubstr("'wooden'"), HasSubstr("custom_source")));
  EXPECT_THAT(Complaint("dmc_reacher_easy_random0", [](json& d) { d.erase("sampled_qpos"); }),
              HasSubstr("'sampled_qpos' is missing"));
  EXPECT_THAT(Complaint("dmc_cheetah_run_random0",
                        [](json& d) {
                          d["reset"]["obs"] = {1, 2};
                        }),
              HasSubstr("'reset.obs' is not 17 finite numbers"));
  EXPECT_THAT(
      Complaint("dmc_cheetah_run_random0", [](json& d) { d["trajectory"][3]["action"][0] = 1.5; }),
      HasSubstr("'trajectory[3].action' has a component outside [-1, 1]"));
  EXPECT_THAT(Complaint("dmc_cheetah_run_random0", [](json& d) { d["env"] = "snail_run"; }),
              testing::AllOf(HasSubstr("snail_run"), HasSubstr("cheetah_run")));
  EXPECT_THAT(Complaint("dmc_reacher_easy_random0", [](json& d) { d.erase("target_xy"); }),
              HasSubstr("'target_xy' is missing"));
}

}  // namespace
}  // namespace shoal::worlds
