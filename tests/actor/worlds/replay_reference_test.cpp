#include "actor/worlds/tools/replay_reference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::worlds {
namespace {

const std::string kFolder = SHOAL_GOLDEN "/reference/fetch_Reach_";

class Parity : public testing::TestWithParam<const char*> {};

TEST_P(Parity, OurPhysicsFollowsTheOriginalsWithinItsTolerance) {
  const ReplayReport report = ReplayReference(kFolder + GetParam() + ".json");
  EXPECT_EQ(report.steps, 50);
  EXPECT_EQ(report.environment, "FetchReach-v4");
  EXPECT_EQ(report.sequence, GetParam());
  EXPECT_TRUE(report.passed) << ToText(report);
  const bool folds = report.sequence == "const_z_close";
  EXPECT_EQ(report.tolerance, folds ? 1e-3 : 1e-5);
  // Not a comparison of nothing with nothing.
  EXPECT_EQ(report.deviations.size(), 12u);
  EXPECT_GT(report.deviations.front().largest, 0);
}

INSTANTIATE_TEST_SUITE_P(FetchReach, Parity,
                         testing::Values("zero", "const_x", "const_down_open", "const_z_close",
                                         "random0", "random_hold5"));

nlohmann::json Golden() { return nlohmann::json::parse(ReadFile(kFolder + "zero.json")); }

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
  const ReplayReport report = ReplayReference(kFolder + "zero.json");
  const nlohmann::ordered_json json = ToJson(report);
  EXPECT_EQ(json["schema"], "shoal-parity-1");
  EXPECT_EQ(json["passed"], true);
  EXPECT_EQ(json["deviations"].size(), report.deviations.size());
  for (const auto& quantity : json["deviations"]) {
    const bool judged = Find(report, quantity["quantity"]).tolerance > 0;
    EXPECT_EQ(quantity["tolerance"].is_number(), judged);
  }
}

}  // namespace
}  // namespace shoal::worlds
