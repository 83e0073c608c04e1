// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/page_answers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "launch/watch/run_figures.h"
#include "launch/watch/top_table.h"
#include "tests/support/error_message.h"

namespace shoal::launch {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

RunViewMessage View() {
  RunViewMessage view;
  view.schema = "shoal-top-1";
  view.run = "reach";
  view.state = "running";
  view.time = 1795370982.5;
  view.env_steps = 1200;
  view.updates = 300;
  MetricsMessage coordinator;
  coordinator.role = "coordinator";
  coordinator.names = {
      "budget_env_steps",       "env_steps_per_second",    "seconds_left",
      "last_evaluation_return", "last_evaluation_success", "last_evaluation_env_steps"};
  coordinator.values = {2400, 60, 20, -1.5, 0.25, 1000};
  MetricsMessage learner;
  learner.role = "learner";
  learner.names = {"updates", "critic_loss"};
  learner.values = {300, std::numeric_limits<double>::quiet_NaN()};
  view.processes = {coordinator, learner};
  view.events = {{.number = 1, .time = 5, .text = "an actor came \xff back"}};
  return view;
}

TEST(PageAnswers, TheViewIsThatOfShoalTop) {
  const json answer = json::parse(TopAnswer(View()));
  EXPECT_EQ(answer.at("view"), json::parse(TopJson(View())));
  const TopCells cells = MakeTopCells(View());
  EXPECT_EQ(answer.at("columns").get<std::vector<std::string>>(), cells.columns);
  EXPECT_EQ(answer.at("rows").get<std::vector<std::vector<std::string>>>(), cells.rows);
  EXPECT_EQ(answer.at("advice"), AdviceOfView(View()));
  const json& progress = answer.at("progress");
  EXPECT_EQ(progress.at("env_steps"), 1200);
  EXPECT_EQ(progress.at("budget_env_steps"), 2400);
  EXPECT_EQ(progress.at("seconds_left"), 20);
  EXPECT_EQ(progress.at("last_evaluation").at("success"), 0.25);
  EXPECT_TRUE(progress.at("best").is_null());
  EXPECT_EQ(progress.at("trouble"), "");
}

TEST(PageAnswers, SayWhichActorsDoNotWork) {
  RunViewMessage view = View();
  view.trouble = "actors 1 of 2: actor-1: exit code 1";
  const json answer = json::parse(TopAnswer(view));
  EXPECT_EQ(answer.at("progress").at("trouble"), view.trouble);
  EXPECT_EQ(answer.at("view").at("trouble"), view.trouble);
}

TEST(PageAnswers, WhatIsNotUtf8IsReplaced) {
  const json answer = json::parse(TopAnswer(View()));
  EXPECT_EQ(answer.at("events")[0][1], "an actor came \xef\xbf\xbd back");
  EXPECT_EQ(json::parse(ErrorAnswer("no \xff")).at("error"), "no \xef\xbf\xbd");
}

TEST(PageAnswers, RunsAreThoseOfShoalRuns) {
  RunListing run;
  run.name = "reach";
  run.env_steps = 7;
  const json answer = json::parse(RunsAnswer("runs", {run}));
  EXPECT_EQ(answer.at("runs"), json::parse(RunListJson("runs", {run})));
  EXPECT_THAT(answer.at("keys"), ::testing::Contains("eval.interval"));
  EXPECT_THAT(answer.at("keys"), ::testing::Not(::testing::Contains("actors")));
}

TEST(PageAnswers, ARunsAnswerSaysWhichEpisodeIsShown) {
  const PlayedEpisode episode{.state = PlayedEpisode::State::kFailed,
                              .checkpoint = "step_7",
                              .env_steps = 70,
                              .seed = 3,
                              .problem = "the disk is full"};
  const json answer = json::parse(RunAnswer("step_8", {{"videos/best.mp4", 4, 2.5}}, episode));
  EXPECT_EQ(answer.at("checkpoint"), "step_8");
  EXPECT_EQ(answer.at("files")[0],
            json({{"path", "videos/best.mp4"}, {"bytes", 4}, {"modified", 2.5}}));
  EXPECT_EQ(answer.at("episode").at("state"), "failed");
  EXPECT_EQ(answer.at("episode").at("env_steps"), 70);
  EXPECT_EQ(answer.at("episode").at("problem"), "the disk is full");
  EXPECT_EQ(answer.at("episode").at("film"), false);
}

TEST(PageAnswers, AnOrderIsAVerbWithItsArgument) {
  const PageOrder set = ParsePageOrder(R"({"verb": "set", "arguments": ["eval.interval=5"]})");
  EXPECT_EQ(set.verb, "set");
  EXPECT_EQ(set.arguments, std::vector<std::string>{"eval.interval=5"});
  EXPECT_TRUE(ParsePageOrder(R"({"verb": "stop", "arguments": []})").arguments.empty());
}

TEST(PageAnswers, OtherOrdersAreRefused) {
  for (const char* body :
       {"{}", "[]", "1", R"({"verb": "stop"})", R"({"verb": "kill", "arguments": []})",
        R"({"verb": 1, "arguments": []})", R"({"verb": "stop", "arguments": {}})",
        R"({"verb": "stop", "arguments": [1]})", R"({"verb": "stop", "arguments": [], "x": 1})",
        R"({"verb": "set", "arguments": ["a=1", "b=2"]})"}) {
    EXPECT_THAT(UsageMessage([&] { ParsePageOrder(body); }), HasSubstr("expected {\"verb\""))
        << body;
  }
  EXPECT_NE(UsageMessage([] { ParsePageOrder(""); }), "");
  EXPECT_NE(UsageMessage([] { ParsePageOrder(std::string(5000, '[')); }), "");
}

}  // namespace
}  // namespace shoal::launch
