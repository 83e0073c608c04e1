// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/replay_reference.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/files.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal::worlds {
namespace {

const std::string kFolder = GoldenPath("reference/fetch_");
const std::string kZero = kFolder + "Reach_zero.json";

struct Recorded {
  const char* task;
  const char* sequence;
  int first_hit = 0;
};

void PrintTo(const Recorded& recorded, std::ostream* out) {
  *out << recorded.task << " " << recorded.sequence;
}

class Parity : public testing::TestWithParam<Recorded> {};

TEST_P(Parity, OurPhysicsFollowsTheOriginalsWithinItsTolerance) {
  const auto& [task, sequence, first_hit] = GetParam();
  const ReplayReport report = ReplayReference(fmt::format("{}{}_{}.json", kFolder, task, sequence));
  EXPECT_EQ(report.steps, 50);
  EXPECT_EQ(report.environment, fmt::format("Fetch{}-v4", task));
  EXPECT_EQ(report.sequence, sequence);
  EXPECT_EQ(report.physics, "mujoco2");
  EXPECT_TRUE(report.passed) << ToText(report);
  const bool folds = report.sequence == "const_z_close";
  EXPECT_EQ(report.tolerance, folds ? 1e-3 : 1e-5);
  EXPECT_EQ(report.chaotic_from, first_hit);
  // One contact more or less for a step where the arm folds onto itself.
  EXPECT_LE(report.contact_mismatches, folds ? 1 : 0);
  // Not a comparison of nothing with nothing.
  EXPECT_GE(report.deviations.size(), 12u);
  EXPECT_GT(report.deviations.front().largest, 0);
}

INSTANTIATE_TEST_SUITE_P(FetchReach, Parity,
                         testing::Values(Recorded{"Reach", "zero"}, Recorded{"Reach", "const_x"},
                                         Recorded{"Reach", "const_down_open"},
                                         Recorded{"Reach", "const_z_close"},
                                         Recorded{"Reach", "random0"},
                                         Recorded{"Reach", "random_hold5"}));
INSTANTIATE_TEST_SUITE_P(FetchPush, Parity,
                         testing::Values(Recorded{"Push", "zero"},
                                         Recorded{"Push", "const_z_close"},
                                         Recorded{"Push", "random_hold5"}));
INSTANTIATE_TEST_SUITE_P(FetchSlide, Parity,
                         testing::Values(Recorded{"Slide", "const_z_close"},
                                         Recorded{"Slide", "const_down_open"},
                                         Recorded{"Slide", "scripted", 12}));
INSTANTIATE_TEST_SUITE_P(FetchPickAndPlace, Parity,
                         testing::Values(Recorded{"PickAndPlace", "scripted"},
                                         Recorded{"PickAndPlace", "const_z_close"},
                                         Recorded{"PickAndPlace", "const_down_open"},
                                         Recorded{"PickAndPlace", "random_hold5"}));

nlohmann::json Golden() { return nlohmann::json::parse(ReadFile(kZero)); }

ReplayReport ReplayEdited(const nlohmann::json& document) {
  const TemporaryFolder folder;
  WriteFileAtomically(folder.path() / "edited.json", document.dump());
  return ReplayReference(folder.path() / "edited.json");
}

const Deviation& Find(const ReplayReport& report, const std::string& quantity) {
  for (const Deviation& deviation : report.deviations) {
    if (deviation.quantity == quantity) return deviation;
  }
  throw std::runtime_error("no quantity " + quantity);
}

TEST(ReplayReference, ADifferenceBeyondTheToleranceFailsAndIsNamedWithItsStep) {
  nlohmann::json document = Golden();
  double& x = document["trajectory"][16]["obs"][0].get_ref<double&>();
  x += 3e-5;
  const ReplayReport report = ReplayEdited(document);
  EXPECT_FALSE(report.passed);
  const Deviation& grip = Find(report, "grip_position");
  EXPECT_NEAR(grip.largest, 3e-5, 1e-8);
  EXPECT_EQ(grip.at_step, 17);
  EXPECT_FALSE(grip.Passed());
  EXPECT_TRUE(Find(report, "achieved_goal").Passed());
  EXPECT_THAT(ToText(report), testing::HasSubstr("FAILED"));
}

TEST(ReplayReference, AnotherActionIsNoticed) {
  nlohmann::json document = Golden();
  document["trajectory"][10]["action"] = {0.125, 0, 0, 0};
  EXPECT_FALSE(ReplayEdited(document).passed);
}

TEST(ReplayReference, WrongRewardsAndFlagsAreCounted) {
  nlohmann::json document = Golden();
  nlohmann::json& step = document["trajectory"][4];
  step["reward_sparse"] = step["reward_sparse"].get<double>() == 0 ? -1 : 0;
  step["is_success"] = step["is_success"].get<double>() == 0 ? 1 : 0;
  const ReplayReport report = ReplayEdited(document);
  EXPECT_EQ(report.reward_mismatches, 1);
  EXPECT_EQ(report.success_mismatches, 1);
  EXPECT_FALSE(report.passed);
}

TEST(ReplayReference, TheJsonHoldsEveryQuantity) {
  const ReplayReport report = ReplayReference(kZero);
  const nlohmann::ordered_json json = ToJson(report);
  EXPECT_EQ(json["schema"], "shoal-parity-1");
  EXPECT_EQ(json["passed"], true);
  EXPECT_EQ(json["deviations"].size(), report.deviations.size());
  for (const auto& quantity : json["deviations"]) {
    const bool judged = Find(report, quantity["quantity"]).tolerance > 0;
    EXPECT_EQ(quantity["tolerance"].is_number(), judged);
  }
}

TEST(ReplayReference, APuckThatIsHitIsNotJudgedFromThatStepOn) {
  nlohmann::json document = nlohmann::json::parse(ReadFile(kFolder + "Slide_scripted.json"));
  const auto move_puck = [&document](size_t step) {
    nlohmann::json& state = document["trajectory"][step];
    for (const size_t i : {3u, 6u}) {
      state["obs"][i] = state["obs"][i].get<double>() + 0.02;
    }
    state["achieved_goal"][0] = state["achieved_goal"][0].get<double>() + 0.02;
  };
  move_puck(30);
  EXPECT_TRUE(ReplayEdited(document).passed);
  move_puck(5);
  const ReplayReport report = ReplayEdited(document);
  EXPECT_FALSE(report.passed);
  EXPECT_EQ(Find(report, "object_position").at_step, 6);
}

TEST(ReplayReference, TheSoftenedWeldDoesNotFollowMujoco2) {
  const ReplayReport report =
      ReplayReference(kFolder + "Reach_const_x.json", {.model = "", .physics = "mujoco3"});
  EXPECT_EQ(report.physics, "mujoco3");
  EXPECT_FALSE(report.passed);
  EXPECT_GT(Find(report, "grip_position").largest, 0.2);
}

}  // namespace
}  // namespace shoal::worlds
