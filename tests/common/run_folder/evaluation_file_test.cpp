// SPDX-License-Identifier: Apache-2.0
#include "common/run_folder/evaluation_file.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/error_message.h"

namespace shoal {
namespace {

using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::HasSubstr;

// An evaluation of a task with goals and causes of failure.
EvaluationFile OfACheckpoint() {
  EvaluationFile file{
      .summary = {.task = "FetchPush",
                  .checkpoint = "step_900",
                  .version = EvaluationSummary::Version{1'700'000'000'000'000'001, 900},
                  .env_steps = 5000,
                  .aggregate = {.episodes = 2,
                                .success_rate = 0.5,
                                .return_mean = -1.5,
                                .return_std = 0.25,
                                .length_mean = 50,
                                .final_distance_mean = 0.125}},
      .policy = "checkpoint",
      .cameras = {"near"},
      .seed = 7,
      .stream_role = 3,
      .stream_group = 5000,
      .commit = "abc",
      .created = "2026-01-02T03:04:05Z",
      .failures = {{{"never_touched", 1}, {"dropped", 0}}}};
  file.episodes = {{.seed = 0,
                    .success = true,
                    .episode_return = -1,
                    .length = 50,
                    .final_distance = 0.0625,
                    .action_smoothness = 0.5,
                    .goal = EvaluatedEpisode::Goal{{1, 2, 3}, {1, 2, 4}}},
                   {.seed = 1,
                    .success = false,
                    .episode_return = -2,
                    .length = 50,
                    .final_distance = 0.1875,
                    .goal = EvaluatedEpisode::Goal{{1, 2, 3}, {1, 2, 5}, "never_touched"},
                    .body_mass_kg = {{"block", 0.5}}}};
  return file;
}

EvaluationFile OfABaseline() {
  return {.summary = {.task = "Hopper-v5",
                      .aggregate = {.episodes = 1, .return_mean = 3, .return_std = 0}},
          .policy = "random",
          .deterministic = false,
          .episodes = {{.final_distance = std::numeric_limits<double>::quiet_NaN()}}};
}

TEST(EvaluationFile, OfACheckpointHasEveryMemberInOrder) {
  EXPECT_EQ(ToJson(OfACheckpoint()).dump(1), R"({
 "schema": "shoal-eval-1",
 "task": "FetchPush",
 "policy": "checkpoint",
 "checkpoint": "step_900",
 "weights_version": {
  "session": 1700000000000000001,
  "update": 900
 },
 "env_steps": 5000,
 "deterministic": true,
 "cameras": [
  "near"
 ],
 "seeds": [
  7
 ],
 "stream": {
  "role": 3,
  "group": 5000
 },
 "episodes": [
  {
   "seed": 0,
   "success": true,
   "return": -1.0,
   "length": 50,
   "final_distance": 0.0625,
   "action_smoothness": 0.5,
   "desired_goal": [
    1.0,
    2.0,
    3.0
   ],
   "achieved_goal": [
    1.0,
    2.0,
    4.0
   ],
   "failure": null
  },
  {
   "seed": 1,
   "success": false,
   "return": -2.0,
   "length": 50,
   "final_distance": 0.1875,
   "action_smoothness": 0.0,
   "desired_goal": [
    1.0,
    2.0,
    3.0
   ],
   "achieved_goal": [
    1.0,
    2.0,
    5.0
   ],
   "failure": "never_touched",
   "body_mass": {
    "block": 0.5
   }
  }
 ],
 "aggregate": {
  "episodes": 2,
  "success_rate": 0.5,
  "return_mean": -1.5,
  "return_std": 0.25,
  "length_mean": 50.0,
  "final_distance_mean": 0.125
 },
 "commit": "abc",
 "created": "2026-01-02T03:04:05Z",
 "failures": {
  "never_touched": 1,
  "dropped": 0
 }
})");
}

TEST(EvaluationFile, WhatIsNotThereIsNullOrAbsent) {
  const ordered_json object = ToJson(OfABaseline());
  for (const char* member : {"checkpoint", "weights_version"}) {
    EXPECT_TRUE(object.at(member).is_null()) << member;
  }
  for (const char* member : {"success", "final_distance"}) {
    EXPECT_TRUE(object.at("episodes").at(0).at(member).is_null()) << member;
  }
  for (const char* member :
       {"end_on_success", "failures", "episodes_asked", "trained_task", "wall_seconds"}) {
    EXPECT_FALSE(object.contains(member)) << member;
  }
  EvaluationFile file = OfABaseline();
  file.end_on_success = true;
  file.episodes_asked = 4;
  file.trained_task = "Hopper-v4";
  const ordered_json more = ToJson(file);
  EXPECT_EQ(more.at("end_on_success"), true);
  EXPECT_EQ(more.at("episodes_asked"), 4);
  EXPECT_EQ(more.at("trained_task"), "Hopper-v4");
}

TEST(EvaluationFile, ReadsWhatWasWritten) {
  ordered_json object = ToJson(OfACheckpoint());
  SetWallSeconds(12.5, &object);
  const EvaluationSummary summary = SummaryOf(ParseEvaluationObject(object.dump(), "x"), "x");
  EXPECT_EQ(summary.task, "FetchPush");
  EXPECT_EQ(summary.checkpoint, "step_900");
  ASSERT_TRUE(summary.version);
  EXPECT_EQ(summary.version->session, 1'700'000'000'000'000'001u) << "64 bits survive JSON";
  EXPECT_EQ(summary.version->update, 900u);
  EXPECT_EQ(summary.env_steps, 5000u);
  EXPECT_EQ(summary.wall_seconds, 12.5);
  EXPECT_EQ(summary.aggregate.episodes, 2u);
  EXPECT_EQ(summary.aggregate.success_rate, 0.5);
  EXPECT_EQ(summary.aggregate.return_mean, -1.5);
  EXPECT_EQ(summary.aggregate.return_std, 0.25);
  EXPECT_EQ(summary.aggregate.length_mean, 50);
  EXPECT_EQ(summary.aggregate.final_distance_mean, 0.125);
  const EvaluationSummary baseline = SummaryOf(ToJson(OfABaseline()), "x");
  EXPECT_FALSE(baseline.checkpoint || baseline.version || baseline.aggregate.success_rate);
}

TEST(EvaluationFile, WhatIsWrongIsNamedWithItsMember) {
  const ordered_json good = ToJson(OfACheckpoint());
  const auto refused = [&](const char* pointer, const ordered_json& value) {
    ordered_json object = good;
    object[ordered_json::json_pointer(pointer)] = value;
    return ErrorMessage([&] { SummaryOf(object, "final.json"); });
  };
  const auto names = [](const std::string& what) {
    return AllOf(HasSubstr("final.json: "), HasSubstr(what));
  };
  EXPECT_EQ(refused("/env_steps", uint64_t{1}), "");
  EXPECT_THAT(refused("/env_steps", -1), names("'env_steps': expected a count"));
  EXPECT_THAT(refused("/checkpoint", 1), names("'checkpoint': expected a text"));
  EXPECT_THAT(refused("/weights_version", 1), names("'weights_version': expected an object"));
  EXPECT_THAT(refused("/weights_version/update", "1"), names("'weights_version.update'"));
  EXPECT_THAT(refused("/episodes", 1), names("'episodes': expected a list"));
  EXPECT_THAT(refused("/aggregate/return_mean", nullptr),
              names("'aggregate.return_mean': expected a number"));
  for (const char* member : {"success_rate", "return_mean", "length_mean"}) {
    ordered_json object = good;
    object["aggregate"].erase(member);
    EXPECT_THAT(ErrorMessage([&] { SummaryOf(object, "final.json"); }),
                names(fmt::format("no 'aggregate.{}'", member)));
  }
  for (const char* text : {"", "{", "[]", "{}", R"({"schema": "shoal-eval-2"})"}) {
    EXPECT_THAT(ErrorMessage([&] { ParseEvaluationObject(text, "final.json"); }),
                names("'shoal-eval-1'"))
        << text;
  }
}

}  // namespace
}  // namespace shoal
