// SPDX-License-Identifier: Apache-2.0
#include "actor/evaluation/evaluation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "common/base/files.h"
#include "common/checkpoint/checkpoint_files.h"
#include "common/config/run_files.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::actor {
namespace {

using testing::AllOf;
using testing::HasSubstr;

RunConfig RunOf(const std::string& task) {
  RunConfig run;
  run.config.task = task;
  return run;
}

std::vector<EpisodeResult> TwoEpisodes(double final_distance) {
  return {{.seed = 0,
           .figures = {.episode_return = 10,
                       .length = 4,
                       .success = true,
                       .final_distance = final_distance}},
          {.seed = 1,
           .figures = {.episode_return = 20, .length = 6, .final_distance = final_distance}}};
}

TEST(EvaluationJson, ATaskWithGoalsHasSuccessAndDistance) {
  const auto json = EvaluationJson(RunOf("FetchReach"), {}, {}, TwoEpisodes(0.25));
  EXPECT_EQ(json["episodes"][0]["success"], true);
  EXPECT_EQ(json["episodes"][1]["final_distance"], 0.25);
  EXPECT_EQ(json["aggregate"]["success_rate"], 0.5);
  EXPECT_EQ(json["aggregate"]["final_distance_mean"], 0.25);
}

TEST(EvaluationJson, AFaultyEpisodeHasFailedAndIsCounted) {
  std::vector<EpisodeResult> episodes = TwoEpisodes(0.25);
  episodes.push_back({.seed = 2,
                      .figures = {.episode_return = 3,
                                  .length = 2,
                                  .final_distance = std::numeric_limits<double>::quiet_NaN()},
                      .fault = worlds::FaultCause::kDiverged});
  const auto json = EvaluationJson(RunOf("FetchReach"), {}, {}, episodes);
  EXPECT_EQ(json["aggregate"]["faulty_episodes"], 1);
  EXPECT_NEAR(json["aggregate"]["success_rate"].get<double>(), 1.0 / 3, 1e-12);
  EXPECT_EQ(json["aggregate"]["final_distance_mean"], 0.25) << "of those that have one";
  EXPECT_EQ(json["episodes"][2]["fault"], "diverged");
  EXPECT_FALSE(json["episodes"][0].contains("fault"));
  EXPECT_FALSE(EvaluationJson(RunOf("FetchReach"), {}, {}, TwoEpisodes(0))["aggregate"].contains(
      "faulty_episodes"));
}

TEST(EvaluationJson, WhatATaskDoesNotHaveIsNull) {
  const auto json = EvaluationJson(RunOf("Hopper-v5"), {}, {},
                                   TwoEpisodes(std::numeric_limits<double>::quiet_NaN()));
  for (const auto& episode : json["episodes"]) {
    EXPECT_TRUE(episode["success"].is_null());
    EXPECT_TRUE(episode["final_distance"].is_null());
    EXPECT_FALSE(episode.contains("body_mass"));
  }
  EXPECT_TRUE(json["aggregate"]["success_rate"].is_null());
  EXPECT_TRUE(json["aggregate"]["final_distance_mean"].is_null());
  EXPECT_EQ(json["aggregate"]["return_mean"], 15);
  EXPECT_EQ(json["aggregate"]["return_std"], 5);
  EXPECT_EQ(json["aggregate"]["length_mean"], 5);
}

TEST(EvaluationStream, EachEvaluationHasEpisodesOfItsOwn) {
  const auto key = [](int64_t seed, uint64_t env_steps, uint64_t updates) {
    return EvaluationStream(seed, env_steps, updates).Key(0);
  };
  EXPECT_EQ(key(7, 1000, 400), key(7, 1000, 400)) << "a checkpoint that is evaluated again";
  EXPECT_NE(key(7, 1000, 400), key(7, 1000, 401)) << "another one after as many env steps";
  EXPECT_NE(key(7, 1000, 400), key(7, 1001, 400));
  EXPECT_NE(key(7, 1000, 400), key(8, 1000, 400));
  EXPECT_NE(key(7, 1000, 400), (EpisodeStream{7, StreamRole::kFinalEnvironment, 0}.Key(0)));
}

// End to end: no-op actions never touch the block of FetchPush.
TEST(EvaluationJson, FailedEpisodesHaveACauseAndAreCountedByIt) {
  RunConfig run = RunOf("FetchPush");
  run.config.observation.pixels = false;
  run.config.observation.proprioception = true;
  run.config.eval.envs = 2;
  run.config.network.hidden = {8};
  run.spec = worlds::MakeEnvironment(run.config, nullptr)->spec();
  Evaluator evaluator(run, /*noop=*/true);
  const EpisodeStream stream{7, StreamRole::kFinalEnvironment, 0};
  const auto json =
      EvaluationJson(run, {}, stream, evaluator.Play(6, stream, [] { return false; }));
  size_t failed = 0;
  for (const auto& episode : json["episodes"]) {
    const auto desired = episode["desired_goal"].get<std::vector<double>>();
    const auto achieved = episode["achieved_goal"].get<std::vector<double>>();
    ASSERT_EQ(desired.size(), 3u);
    ASSERT_EQ(achieved.size(), 3u);
    EXPECT_NEAR(
        std::hypot(desired[0] - achieved[0], desired[1] - achieved[1], desired[2] - achieved[2]),
        episode["final_distance"].get<double>(), 1e-5);
    EXPECT_EQ(episode["failure"].is_null(), episode["success"] == true);
    if (episode["failure"].is_null()) continue;
    EXPECT_EQ(episode["failure"], "never_touched");
    ++failed;
  }
  EXPECT_GT(failed, 0u);
  EXPECT_EQ(json["failures"]["never_touched"], failed);
  EXPECT_EQ(json["failures"].size(), 11u);
  EXPECT_FALSE(EvaluationJson(RunOf("Hopper-v5"), {}, {}, {}).contains("failures"));
}

// The whole way: configuration, environment, JSON.
TEST(EvaluationJson, HoldsTheMassesDrawnForEachEpisode) {
  RunConfig run = RunOf("CustomHopper-source");
  run.config.observation.pixels = false;
  run.config.observation.proprioception = true;
  run.config.randomization.body_mass = {{"thigh", {3.4, 4.4}}, {"leg", {2.2, 3.2}}};
  run.config.eval.envs = 2;
  run.config.network.hidden = {8};
  run.spec = worlds::MakeEnvironment(run.config, nullptr)->spec();
  Evaluator evaluator(run);
  const EpisodeStream stream{7, StreamRole::kFinalEnvironment, 0};
  const auto json =
      EvaluationJson(run, {}, stream, evaluator.Play(3, stream, [] { return false; }));
  std::vector<double> thighs;
  for (const auto& episode : json["episodes"]) {
    ASSERT_EQ(episode["body_mass"].size(), 2u);
    EXPECT_GE(episode["body_mass"]["leg"], 2.2);
    EXPECT_LE(episode["body_mass"]["leg"], 3.2);
    thighs.push_back(episode["body_mass"]["thigh"]);
  }
  EXPECT_NE(thighs[0], thighs[1]);
  EXPECT_NE(thighs[1], thighs[2]);
}

// Four environments at once, whose episodes of falling robots end at different steps.
TEST(Evaluator, StoppedItHasTheFirstEpisodesAsIfNoMoreHadBeenAsked) {
  RunConfig run = RunOf("Hopper-v5");
  run.config.observation.pixels = false;
  run.config.observation.proprioception = true;
  run.config.eval.envs = 4;
  run.config.network.hidden = {8};
  run.spec = worlds::MakeEnvironment(run.config, nullptr)->spec();
  Evaluator evaluator(run);
  const EpisodeStream stream{7, StreamRole::kFinalEnvironment, 0};
  const auto lengths = [&](int episodes, int most_steps) {
    int steps = 0;
    std::vector<int64_t> result;
    for (const auto& episode :
         evaluator.Play(episodes, stream, [&] { return steps++ == most_steps; })) {
      EXPECT_EQ(episode.seed, int64_t(result.size()));
      result.push_back(episode.figures.length);
    }
    return result;
  };
  std::vector<int> told;
  evaluator.Play(
      3, stream, [] { return false; }, [&](int ended) { told.push_back(ended); });
  EXPECT_THAT(told, testing::ElementsAre(1, 2, 3));
  const std::vector<int64_t> whole = lengths(20, 1'000'000);
  ASSERT_EQ(whole.size(), 20u);
  size_t partial = 0;
  for (int most_steps = 0; most_steps < 100; most_steps += 7) {
    const std::vector<int64_t> some = lengths(20, most_steps);
    ASSERT_LE(some.size(), whole.size());
    EXPECT_TRUE(std::ranges::equal(some, std::span(whole).first(some.size()))) << most_steps;
    partial += !some.empty() && some.size() < whole.size();
  }
  EXPECT_GT(partial, 3u);
}

// The first observation of the policy in each episode.
class FirstPictures final : public EpisodeListener {
 public:
  void OnBegin(uint64_t, std::span<const uint8_t> stack) override {
    seen.emplace_back(stack.begin(), stack.end());
  }
  void OnStep(const SeenStep&) override {}
  void OnFault(std::span<const uint8_t>) override {}

  std::vector<std::vector<uint8_t>> seen;
};

// The arm starts every episode in the same place: two first pictures differ by their goals alone.
TEST(Evaluator, WithHindsightThePolicysPicturesDoNotShowTheGoal) {
  for (const bool hindsight : {false, true}) {
    RunConfig run = RunOf("FetchReach");
    run.config.observation.goal_mode = "desired";
    run.config.observation.height = run.config.observation.width = 48;
    run.config.replay.hindsight = hindsight ? "future" : "none";
    run.config.eval.envs = 1;
    run.config.network.hidden = {8};
    run.spec =
        worlds::MakeEnvironment(run.config, worlds::MakeRenderContext(run.config.observation))
            ->spec();
    Evaluator evaluator(run, /*noop=*/true);
    FirstPictures pictures;
    evaluator.Listen(&pictures);
    evaluator.Play(2, {7, StreamRole::kEvalEnvironment, 0},
                   [&] { return pictures.seen.size() == 2; });
    ASSERT_EQ(pictures.seen.size(), 2u);
    EXPECT_EQ(pictures.seen[0] == pictures.seen[1], hindsight);
  }
}

// A checkpoint with a policy that cannot be loaded: it must be refused before loading.
class EvaluateCheckpointTest : public testing::Test {
 protected:
  EvaluateCheckpointTest() {
    RunConfig run = RunOf("Hopper-v5");
    run.config.observation.pixels = false;
    run.config.observation.proprioception = true;
    run.spec = worlds::MakeEnvironment(run.config, nullptr)->spec();
    WriteRunConfig(run_.path(), run);
    Write(run.spec.Hash());
  }

  void Write(uint64_t spec_hash) const {
    CheckpointFiles files;
    files.state.updates = 7;
    files.state.spec_hash = spec_hash;
    files.policy = "not safetensors";
    WriteCheckpointFiles(run_.path(), files, {});
  }

  std::string Refusal() const {
    return ErrorMessage([&] { EvaluateCheckpoint(run_.path(), folder_, {.episodes = 1}); });
  }

  void Replace(const std::string& file, const std::string& from, const std::string& to) const {
    std::string bytes = ReadFile(folder_ / file);
    bytes.replace(bytes.find(from), from.size(), to);
    WriteFileAtomically(folder_ / file, bytes);
  }

  const TemporaryFolder run_;
  const std::filesystem::path folder_ = run_.path() / CheckpointName(7);
};

TEST_F(EvaluateCheckpointTest, AnAlteredPolicyIsRefusedByChecksum) {
  Replace("policy.safetensors", "not", "nou");
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("policy.safetensors"), HasSubstr("CRC-32")));
}

TEST_F(EvaluateCheckpointTest, ATruncatedPolicyIsRefused) {
  Replace("policy.safetensors", "tensors", "");
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("policy.safetensors"), HasSubstr("8 bytes, expected 15")));
}

TEST_F(EvaluateCheckpointTest, AnotherVersionIsRefusedNamingBoth) {
  Replace("state.json", "shoal-checkpoint-1", "shoal-checkpoint-2");
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("shoal-checkpoint-1"), HasSubstr("shoal-checkpoint-2")));
}

TEST_F(EvaluateCheckpointTest, ACheckpointOfAnotherObservationIsRefused) {
  Write(0x1234);
  EXPECT_THAT(Refusal(), HasSubstr("observation spec 0000000000001234"));
}

TEST_F(EvaluateCheckpointTest, AWholeCheckpointIsTaken) {
  EXPECT_THAT(Refusal(), HasSubstr("weights of update 7")) << "refused only when it is loaded";
}

}  // namespace
}  // namespace shoal::actor
