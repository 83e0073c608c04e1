// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/run_curves.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "launch/record/evaluations.h"
#include "tests/launch/evaluation_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using nlohmann::json;

std::string LearnerLine(int env_steps, double loss) {
  return R"({"t":1,"role":"learner","id":0,"env_steps":)" + std::to_string(env_steps) +
         R"(,"critic_loss":)" + std::to_string(loss) + R"(,"q_mean":3,"updates_per_second":10})";
}

class RunCurvesTest : public ::testing::Test {
 protected:
  void Append(const std::string& text) const {
    std::ofstream(folder_.path() / "metrics.jsonl", std::ios::app) << text;
  }
  // Points of the first series of a chart; null when there is no such chart.
  json Points(const std::string& id) const {
    const json answer = json::parse(curves_.Json());
    for (const json& chart : answer.at("charts")) {
      if (chart.at("id") == id) return chart.at("series")[0].at("points");
    }
    return {};
  }
  const TemporaryFolder folder_;
  RunCurves curves_{folder_.path()};
};

TEST_F(RunCurvesTest, ARunWithoutFilesHasNoCurves) {
  curves_.ReadOn();
  const json answer = json::parse(curves_.Json());
  EXPECT_EQ(answer.at("complete"), true);
  EXPECT_TRUE(answer.at("charts").empty());
}

TEST_F(RunCurvesTest, FiguresAreOverTheLearnersEnvSteps) {
  Append(LearnerLine(100, 0.5) + "\n" +
         R"({"t":2,"role":"coordinator","id":0,"env_steps_per_second":40,"rollout_success":0.25})"
         "\n" +
         LearnerLine(200, 0.25) + "\n");
  curves_.ReadOn();
  EXPECT_EQ(Points("critic_loss"), json({{100.0, 0.5}, {200.0, 0.25}}));
  EXPECT_EQ(Points("env_steps_per_second"), json::array({{100.0, 40.0}}));
  EXPECT_EQ(Points("success"), json::array({{100.0, 0.25}}));
  EXPECT_EQ(Points("updates_per_second").size(), 2u);
  EXPECT_TRUE(Points("q_mean").is_null()) << "no headline";
}

TEST_F(RunCurvesTest, TheActorsEpisodesAreOverTheRunsEnvSteps) {
  Append(LearnerLine(100, 0.5) + "\n" +
         R"({"t":2,"role":"coordinator","id":0,"env_steps":150,"rollout_return":-7})" + "\n");
  curves_.ReadOn();
  EXPECT_EQ(Points("return"), json::array({{150.0, -7.0}}));
  EXPECT_EQ(Points("critic_loss"), json::array({{100.0, 0.5}}));
}

TEST_F(RunCurvesTest, WhatIsAppendedIsReadOnceItsLineIsWhole) {
  const std::string second = LearnerLine(200, 0.25);
  Append(LearnerLine(100, 0.5) + "\n" + second.substr(0, 30));
  curves_.ReadOn();
  EXPECT_EQ(Points("critic_loss").size(), 1u);
  Append(second.substr(30) + "\n");
  curves_.ReadOn();
  EXPECT_EQ(Points("critic_loss"), json({{100.0, 0.5}, {200.0, 0.25}}));
}

TEST_F(RunCurvesTest, OnlySoMuchIsReadAtOnce) {
  for (int i = 0; i < 100; ++i) Append(LearnerLine(i, 1) + "\n");
  curves_.ReadOn(/*most_bytes=*/1000);
  EXPECT_EQ(json::parse(curves_.Json()).at("complete"), false);
  const size_t some = Points("critic_loss").size();
  EXPECT_GT(some, 0u);
  EXPECT_LT(some, 30u);
  for (int i = 0; i < 30; ++i) curves_.ReadOn(1000);
  EXPECT_EQ(json::parse(curves_.Json()).at("complete"), true);
  EXPECT_EQ(Points("critic_loss").size(), 100u);
}

TEST_F(RunCurvesTest, AFileThatWasBegunAnewIsReadAnew) {
  Append(LearnerLine(100, 0.5) + "\n" + LearnerLine(200, 0.5) + "\n");
  curves_.ReadOn();
  std::filesystem::remove(folder_.path() / "metrics.jsonl");
  Append(LearnerLine(7, 2) + "\n");
  curves_.ReadOn();
  EXPECT_EQ(Points("critic_loss"), json::array({{7.0, 2.0}}));
  // Another file in its place, though it is longer already.
  std::ofstream(folder_.path() / "new") << LearnerLine(8, 2) + "\n" + LearnerLine(9, 3) + "\n";
  std::filesystem::rename(folder_.path() / "new", folder_.path() / "metrics.jsonl");
  curves_.ReadOn();
  EXPECT_EQ(Points("critic_loss"), json({{8.0, 2.0}, {9.0, 3.0}}));
}

TEST_F(RunCurvesTest, LinesThatMakeNoSenseArePassedOver) {
  Append("\n{\n\"role\":\"learner\"\n[1]\n{\"role\":\"learner\",\"env_steps\":\"x\"}\n" +
         std::string("{\"role\":\"learner\",\"critic_loss\":null}\n") + LearnerLine(1, 2) + "\n");
  curves_.ReadOn();
  EXPECT_EQ(Points("critic_loss"), json::array({{1.0, 2.0}}));
}

TEST_F(RunCurvesTest, EvaluationsComeFromTheirFiles) {
  const auto folder = folder_.path() / "eval";
  std::filesystem::create_directory(folder);
  WriteFaults faults([](const std::string&) {});
  EvaluationStore store(folder_.path(), &faults);
  store.Write(RecordOf(EvaluationMessage(2'500, 100, 0.25), 3.5));
  curves_.ReadOn();
  EXPECT_EQ(Points("success"), json({{2500, 0.25}}));
  EXPECT_EQ(Points("return"), json({{2500, -2.5}}));
  store.Write(RecordOf(EvaluationMessage(5'000, 200, 0.5), 7));
  curves_.ReadOn();
  EXPECT_EQ(Points("success"), json({{2500, 0.25}, {5000, 0.5}}));
  std::ofstream(folder / "steps_5_updates_6.json") << "{";
  curves_.ReadOn();
  EXPECT_EQ(Points("success"), json({{2500, 0.25}, {5000, 0.5}}))
      << "a broken file takes nothing away";
}

TEST(ThinnedCurve, HoldsItsBoundAndTheNewestPoint) {
  ThinnedCurve curve;
  for (int i = 0; i <= 123456; ++i) curve.Add(i, 2 * i);
  const auto points = curve.Points();
  EXPECT_LE(points.size(), ThinnedCurve::kMost + 1);
  EXPECT_GE(points.size(), ThinnedCurve::kMost / 2);
  EXPECT_EQ(points.front().x, 0);
  EXPECT_EQ(points.back().x, 123456);
  EXPECT_EQ(points.back().y, 246912);
  // Evenly spaced, except the newest point.
  for (size_t i = 2; i + 1 < points.size(); ++i) {
    ASSERT_EQ(points[i].x - points[i - 1].x, points[1].x - points[0].x) << i;
  }
}

TEST(ThinnedCurve, FewPointsAreAllThere) {
  ThinnedCurve curve;
  for (int i = 0; i < 999; ++i) curve.Add(i, i);
  EXPECT_EQ(curve.Points().size(), 999u);
  curve.Add(999, 999);
  EXPECT_EQ(curve.Points().back().x, 999);
}

}  // namespace
}  // namespace shoal::launch
