// SPDX-License-Identifier: Apache-2.0
#include "launch/record/evaluations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/launch/evaluation_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using ::testing::HasSubstr;

class EvaluationsTest : public ::testing::Test {
 protected:
  EvaluationsTest() { MakeFolders(run_.path() / "eval"); }
  TemporaryFolder run_;
};

TEST_F(EvaluationsTest, StoreThenReadGivesThePointsInOrder) {
  WriteFaults faults([](const std::string&) {});
  EvaluationStore store(run_.path(), &faults);
  store.Write(RecordOf(EvaluationMessage(10'000, 900, 0.5), 12.5));
  EvaluationRecord record = RecordOf(EvaluationMessage(2'500, 100, 0.25), 3.5);
  const EvaluationPoint stored = record.point;
  store.Write(std::move(record));
  EXPECT_EQ(stored.env_steps, 2'500u);
  EXPECT_EQ(stored.updates, 100u);
  EXPECT_EQ(stored.checkpoint, "step_100");
  EXPECT_EQ(stored.episodes, 2u);
  EXPECT_EQ(stored.final_distance, 0.25);
  WriteFileAtomically(run_.path() / "eval" / "final.json", "not one of them");
  const auto points = ReadEvaluations(run_.path());
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].env_steps, 2'500u);
  EXPECT_EQ(points[0].success, 0.25);
  EXPECT_EQ(points[0].mean_return, -2.5);
  EXPECT_EQ(points[0].wall_seconds, 3.5);
  EXPECT_EQ(points[1].env_steps, 10'000u);
}

// The run's folder was moved away for a while.
TEST_F(EvaluationsTest, WhatCannotBeWrittenIsKeptAndWrittenLater) {
  std::vector<std::string> said;
  WriteFaults faults([&](const std::string& line) { said.push_back(line); });
  EvaluationStore store(run_.path(), &faults);
  const auto folder = run_.path() / "eval", elsewhere = run_.path() / "moved";
  std::filesystem::rename(folder, elsewhere);
  store.Write(RecordOf(EvaluationMessage(2'500, 100, 0.25), 3.5));
  store.Write(RecordOf(EvaluationMessage(5'000, 200, 0.5), 7));
  store.Retry();
  EXPECT_THAT(faults.failing(), testing::ElementsAre("eval"));
  ASSERT_EQ(said.size(), 1u) << "it is said once";
  EXPECT_THAT(said[0], testing::HasSubstr("No such file or directory"));
  std::filesystem::rename(elsewhere, folder);
  store.Retry();
  EXPECT_TRUE(faults.failing().empty());
  EXPECT_EQ(said.size(), 2u);
  EXPECT_EQ(ReadEvaluations(run_.path()).size(), 2u);
}

TEST_F(EvaluationsTest, RefusesWhatIsNotAnEvaluation) {
  for (const char* json : {"", "[]", "{}", R"({"schema": "shoal-eval-1"})", R"({"schema": 1})"}) {
    EvalMessage message = EvaluationMessage(1, 1, 1);
    message.json = json;
    EXPECT_THROW(RecordOf(message, 0), Error) << json;
  }
  EXPECT_TRUE(std::filesystem::is_empty(run_.path() / "eval"));
}

TEST_F(EvaluationsTest, RefusesFiguresThatCannotBe) {
  const auto refused = [](const char* path, const nlohmann::json& value) {
    EvalMessage message = EvaluationMessage(1, 1, 1);
    auto object = nlohmann::json::parse(message.json);
    object[nlohmann::json::json_pointer(path)] = value;
    message.json = object.dump();
    try {
      ParseEvaluation(message);
      return false;
    } catch (const Error&) {
      return true;
    }
  };
  EXPECT_FALSE(refused("/aggregate/success_rate", 1.0)) << "the message itself is good";
  EXPECT_TRUE(refused("/aggregate/success_rate", 5.0));
  EXPECT_TRUE(refused("/aggregate/success_rate", -0.1));
  EXPECT_TRUE(refused("/aggregate/return_mean", "1e999"));
  EXPECT_TRUE(refused("/episodes", nlohmann::json::array()));
  // The JSON describes another evaluation than the message.
  EXPECT_TRUE(refused("/env_steps", 2));
  EXPECT_TRUE(refused("/weights_version/update", 2));
  EXPECT_TRUE(refused("/weights_version/session", 2));
  EXPECT_TRUE(refused("/checkpoint", "step_2"));
}

TEST_F(EvaluationsTest, RefusesADeepNesting) {
  EvalMessage message = EvaluationMessage(1, 1, 1);
  const std::string deep = std::string(1'000'000, '[') + std::string(1'000'000, ']');
  message.json = R"({"x": )" + deep + "," + message.json.substr(1);
  EXPECT_THROW(RecordOf(message, 0), Error);
}

TEST_F(EvaluationsTest, RefusesACheckpointOutsideOfTheRun) {
  for (const char* name : {"..", "../../elsewhere", "/etc"}) {
    EvalMessage message = EvaluationMessage(1, 1, 1);
    auto object = nlohmann::json::parse(message.json);
    object["checkpoint"] = name;
    message.json = object.dump();
    EXPECT_THROW(RecordOf(message, 0), Error) << name;
  }
  EXPECT_TRUE(std::filesystem::is_empty(run_.path() / "eval"));
}

TEST_F(EvaluationsTest, ATaskWithoutSuccessHasNoneAndStillAReturn) {
  EvalMessage message = EvaluationMessage(1, 1, 1);
  auto object = nlohmann::json::parse(message.json);
  object["aggregate"]["success_rate"] = nullptr;
  const EvaluationPoint point = ParseEvaluation(object.dump(), "x");
  EXPECT_EQ(point.success, std::nullopt);
  EXPECT_EQ(point.mean_return, -2.5);
}

}  // namespace
}  // namespace shoal::launch
