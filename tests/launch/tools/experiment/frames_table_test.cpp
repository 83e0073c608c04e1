// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/frames_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;

FramesRun RunOfSeed(int64_t seed, const std::vector<std::pair<int64_t, double>>& returns) {
  FramesRun run{.seed = seed};
  for (const auto& [frames, value] : returns) {
    run.returns.push_back({.frames = frames,
                           .env_steps = static_cast<uint64_t>(frames) / 2,
                           .episodes = 10,
                           .return_mean = value});
  }
  return run;
}

FramesResults Results() {
  FramesResults results{.frames = {100, 500}};
  results.arms = {{.name = "first",
                   .task = "reacher_easy",
                   .runs = {RunOfSeed(0, {{100, 10}, {500, 100}}), RunOfSeed(1, {{100, 20}})}},
                  {.name = "second",
                   .task = "cheetah_run",
                   .runs = {RunOfSeed(0, {{100, 30}}), {.seed = 1, .failed = true}}}};
  SetReference(
      {.name = "r",
       .source = "s",
       .results = {{.method = "DrQ", .task = "reacher_easy", .frames = {100}, .returns = {601.5}},
                   {.method = "DrQ", .task = "cheetah_run", .frames = {100}, .returns = {344}},
                   {.method = "B", .task = "reacher_easy", .frames = {100}, .returns = {-1.659}}}},
      &results);
  return results;
}

TEST(FramesTable, HasARowPerArmAndTheMeanOfTasks) {
  EXPECT_EQ(FramesText(Results()),
            "mean return at environment frames (env steps x action repeat):\n"
            "ARM              100 [95 %]                          500 [95 %]\n"
            "first            15 [-49, 79] (2 seeds)              100.0 (1 seed)\n"
            "second           30.00 (1 seed; 1 failed, left out)  - (1 failed)\n"
            "mean of 2 tasks  20.00 (1 seed; 1 failed, left out)  - (1 failed)\n"
            "reference r at 100 environment frames:\n"
            "TASK             DrQ    B\n"
            "reacher_easy     601.5  -1.66\n"
            "cheetah_run      344    -\n"
            "mean of 2 tasks  472.8  -\n");
}

TEST(FramesTable, OfOneTaskItHasNoMeanOfTasks) {
  FramesResults results = Results();
  results.arms[1].task = "reacher_easy";
  EXPECT_EQ(FramesRows(results).size(), 3u);
  EXPECT_EQ(PublishedRows(results, 100).size(), 2u) << "headings and the task, once";
}

TEST(FramesTable, IsEmptyWithoutFrames) {
  EXPECT_EQ(FramesText({}), "");
  EXPECT_TRUE(ReadFramesResults({{"arms", ordered_json::array()}}).frames.empty());
}

// A summary of `results`, as summary.json has it.
ordered_json SummaryOf(const FramesResults& results) {
  ordered_json arms = ordered_json::array();
  for (const FramesArm& arm : results.arms) {
    ordered_json runs = ordered_json::array();
    for (const FramesRun& run : arm.runs) {
      runs.push_back({{"seed", run.seed},
                      {"status", run.failed ? "failed" : "interrupted"},
                      {"at_frames", AtFramesJson(run.returns)}});
    }
    arms.push_back({{"name", arm.name}, {"runs", runs}, {"task", arm.task}});
  }
  return {{"frames", results.frames}, {"arms", arms}, {"reference", ReferenceJson(results)}};
}

TEST(FramesTable, AggregatesAreThoseOfTheRows) {
  ordered_json summary = SummaryOf(Results());
  SetFramesAggregates(Results(), &summary);
  const ordered_json& first = summary.at("arms").at(0).at("at_frames");
  ASSERT_EQ(first.size(), 2u);
  EXPECT_EQ(first.at(0).at("frames"), 100);
  EXPECT_EQ(first.at(0).at("return").at("mean"), 15.0);
  EXPECT_EQ(first.at(0).at("return").at("seeds"), 2);
  EXPECT_NEAR(first.at(0).at("return").at("ci95").at(1).get<double>(), 78.531, 1e-3);
  EXPECT_TRUE(first.at(1).at("return").at("ci95").is_null());
  const ordered_json& mean = summary.at("mean_of_tasks");
  EXPECT_EQ(mean.at("tasks"), 2);
  EXPECT_EQ(mean.at("at_frames").at(0).at("return").at("mean"), 20.0);
  EXPECT_EQ(mean.at("at_frames").at(0).at("return").at("failed"), 1);
  EXPECT_TRUE(mean.at("at_frames").at(1).at("return").at("mean").is_null());
}

TEST(FramesTable, IsReadBackFromTheRows) {
  const ordered_json summary = SummaryOf(Results());
  const FramesResults read = ReadFramesResults(summary);
  EXPECT_EQ(FramesText(read), FramesText(Results()));
  EXPECT_EQ(SummaryOf(read), summary);
  EXPECT_EQ(read.source, "s");
}

}  // namespace
}  // namespace shoal::launch
