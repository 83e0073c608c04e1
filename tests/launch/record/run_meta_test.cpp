// SPDX-License-Identifier: Apache-2.0
#include "launch/record/run_meta.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/run_folder/learner_device_file.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

TEST(RunMeta, AResumedRunFindsItsCountersAndWhatWasChanged) {
  const TemporaryFolder run;
  RunMeta meta;
  meta.started = "2026-01-31T12:00:00Z";
  meta.env_steps = 7;
  meta.updates = 8;
  meta.wall_seconds = 9.5;
  meta.restarts = 2;
  meta.resends = 30;
  meta.updates_lost = 3;
  meta.cpu_seconds = 17.5;
  meta.energy_wh = 0.25;
  meta.changes = {{.time = "2026-01-31T12:05:00Z",
                   .env_steps = 5,
                   .updates = 6,
                   .key = "replay.samples_per_insert",
                   .from = 64,
                   .to = 32.5}};
  WriteRunMeta(run.path(), Config(), meta);
  const RunMeta back = ReadRunMeta(run.path());
  EXPECT_EQ(back.started, meta.started);
  EXPECT_EQ(back.env_steps, 7u);
  EXPECT_EQ(back.updates, 8u);
  EXPECT_EQ(back.wall_seconds, 9.5);
  EXPECT_EQ(back.restarts, 2);
  EXPECT_EQ(back.resends, 30u);
  EXPECT_EQ(back.updates_lost, 3u);
  EXPECT_EQ(back.cpu_seconds, 17.5);
  EXPECT_EQ(back.energy_wh, 0.25);
  ASSERT_EQ(back.changes.size(), 1u);
  EXPECT_EQ(back.changes[0].time, "2026-01-31T12:05:00Z");
  EXPECT_EQ(back.changes[0].env_steps, 5u);
  EXPECT_EQ(back.changes[0].updates, 6u);
  EXPECT_EQ(back.changes[0].key, "replay.samples_per_insert");
  EXPECT_EQ(back.changes[0].from, 64);
  EXPECT_EQ(back.changes[0].to, 32.5);
}

TEST(RunMeta, SaysWhatThePolicySeesAndHowOftenItWasUpdated) {
  const TemporaryFolder run;
  ObservationSpec spec;
  spec.cameras = {"front"};
  spec.blocks = {{"grip", 4}, {"achieved_goal", 3, false}, {"desired_goal", 3}};
  RunMeta meta;
  meta.policy_inputs = PolicyInputsOf(spec);
  const auto written = [&] {
    WriteRunMeta(run.path(), Config(), meta);
    return nlohmann::json::parse(ReadFile(run.path() / "meta.json"));
  };
  EXPECT_EQ(written().at("policy_inputs"),
            nlohmann::json({{"blocks", {"grip", "desired_goal"}},
                            {"object_blocks", nlohmann::json::array()},
                            {"cameras", {"front"}},
                            {"goal_picture", false}}));
  EXPECT_EQ(written().at("privileged_inputs"),
            nlohmann::json({{"critic_blocks", nlohmann::json::array()},
                            {"labels", nlohmann::json::array()},
                            {"replay_blocks", nlohmann::json::array()}}));
  spec.blocks.push_back({"object", 3});  // a policy that does not have to find it
  meta.policy_inputs = PolicyInputsOf(spec);
  EXPECT_EQ(written().at("policy_inputs").at("object_blocks"), nlohmann::json({"object"}));
  Config config;
  config.sac.critic_blocks = true;
  config.sac.aux = {"achieved_goal-desired_goal"};
  meta.privileged_inputs = PrivilegedInputsOf(config, spec);
  EXPECT_EQ(written().at("privileged_inputs"),
            nlohmann::json({{"critic_blocks", {"achieved_goal"}},
                            {"labels", {"achieved_goal-desired_goal"}},
                            {"replay_blocks", nlohmann::json::array()}}));
  EXPECT_TRUE(written().at("updates_per_env_step").is_null());
  meta.env_steps = 200;
  meta.updates = 100;
  EXPECT_EQ(written().at("updates_per_env_step"), 0.5);
}

TEST(RunMeta, AProblemInAnyEncodingIsWritten) {
  const TemporaryFolder run;
  RunMeta meta;
  meta.error =
      "learner-0: exit code 1: fa\xe7"
      "ade";  // Latin-1
  WriteRunMeta(run.path(), Config(), meta);
  EXPECT_EQ(nlohmann::json::parse(ReadFile(run.path() / "meta.json")).at("error"),
            "learner-0: exit code 1: fa\xef\xbf\xbd"
            "ade");
}

TEST(RunMeta, CountsOfFaultyEpisodesGoOnInAResumedRun) {
  const TemporaryFolder run;
  RunMeta meta;
  meta.faulty_episodes = {{"diverged", 3}, {"reward", 1}};
  WriteRunMeta(run.path(), Config(), meta);
  EXPECT_EQ(ReadRunMeta(run.path()).faulty_episodes, meta.faulty_episodes);
  WriteRunMeta(run.path(), Config(), RunMeta());
  EXPECT_TRUE(ReadRunMeta(run.path()).faulty_episodes.empty());
  auto json = nlohmann::json::parse(ReadFile(run.path() / "meta.json"));
  json.erase("faulty_episodes");  // of an older build
  WriteFileAtomically(run.path() / "meta.json", json.dump());
  EXPECT_TRUE(ReadRunMeta(run.path()).faulty_episodes.empty());
}

TEST(RunMeta, AnOlderFileHasNoChanges) {
  const TemporaryFolder run;
  WriteRunMeta(run.path(), Config(), RunMeta());
  auto json = nlohmann::json::parse(ReadFile(run.path() / "meta.json"));
  json.erase("changes");
  json.erase("resends");
  json.erase("cpu_seconds");
  WriteFileAtomically(run.path() / "meta.json", json.dump());
  EXPECT_TRUE(ReadRunMeta(run.path()).changes.empty());
  EXPECT_EQ(ReadRunMeta(run.path()).resends, 0u);
  EXPECT_FALSE(ReadRunMeta(run.path()).cpu_seconds) << "the earlier sessions did not count it";
}

TEST(RunMeta, ABrokenChangeIsAnError) {
  const TemporaryFolder run;
  WriteRunMeta(run.path(), Config(), RunMeta());
  auto json = nlohmann::json::parse(ReadFile(run.path() / "meta.json"));
  json["changes"] = {{{"key", "eval.interval"}}};
  WriteFileAtomically(run.path() / "meta.json", json.dump());
  EXPECT_THROW(ReadRunMeta(run.path()), Error);
}

TEST(FormatFirstSuccess, SaysThatTheFinalEvaluationIsLower) {
  RunMeta meta;
  meta.target = 0.98;
  EXPECT_EQ(FormatFirstSuccess(meta, 2), "") << "nothing was evaluated";
  meta.best = EvaluationPoint{.success = 0.9};
  EXPECT_EQ(FormatFirstSuccess(meta, 2),
            "while training: no 2 evaluations in a row had success >= 98 % together");
  meta.first_success =
      EvaluationPoint{.env_steps = 60012, .updates = 5400, .wall_seconds = 97.6, .success = 0.98};
  const std::string first =
      "while training: success >= 98 % over 2 evaluations in a row, first from 60012 env steps, "
      "5400 "
      "updates, 98 s on";
  EXPECT_EQ(FormatFirstSuccess(meta, 2), first);
  meta.final_success = 0.98;
  EXPECT_EQ(FormatFirstSuccess(meta, 2), first);
  meta.final_success = 0.94;
  EXPECT_EQ(FormatFirstSuccess(meta, 2),
            first + "; the final evaluation, of other episodes, is below that: 94.0 %");
}

TEST(RunMeta, NamesTheProcessorOfTheLearner) {
  const TemporaryFolder run;
  const auto written = [&] {
    WriteRunMeta(run.path(), Config(), RunMeta());
    return nlohmann::json::parse(ReadFile(run.path() / "meta.json"));
  };
  EXPECT_EQ(written().at("learner_device"),
            nlohmann::json::parse(R"({"device": "cpu", "reason": null})"));
  WriteLearnerDevice(run.path(), {.precision = "f32", .reason = "no driver"});
  EXPECT_EQ(written().at("learner_device").at("reason"), "no driver");
  WriteLearnerDevice(run.path(), {.device = "cuda",
                                  .card = "GPU X",
                                  .driver = "580.1",
                                  .memory_bytes = 85'040'000'000,
                                  .precision = "bf16",
                                  .losses = 1});
  EXPECT_EQ(written().at("learner_device"), nlohmann::json::parse(R"({
    "device": "cuda", "card": "GPU X", "driver": "580.1", "memory_gb": 85.0, "losses": 1})"));
  EXPECT_EQ(written().at("precision"), "bf16");
}

}  // namespace
}  // namespace shoal::launch
