// SPDX-License-Identifier: Apache-2.0
// --resume continues a run and reports what could not be kept.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "common/base/clock.h"
#include "common/base/files.h"
#include "common/base/stop.h"
#include "tests/support/event_files.h"
#include "tests/support/training_run.h"

namespace shoal {
namespace {

ProgramResult Resume(const TrainingRun& run, const std::string& env_steps) {
  return RunProgram(
      {"shoal", "train", "--resume", run.path().string(), "--set", "env_steps=" + env_steps},
      std::chrono::seconds(180));
}

// One file per start of the run, each with every tag; over all files a tag's env steps
// grow.
void ExpectScalars(const std::filesystem::path& run, size_t starts) {
  const auto files = EventFiles(run / "tensorboard");
  ASSERT_EQ(files.size(), starts);
  std::map<std::string, int64_t> reached;
  for (const auto& file : files) {
    const Scalars scalars = ReadScalars(file);
    for (const char* tag :
         {"rollout/ep_rew_mean", "rollout/success_rate", "rollout/ep_len_mean", "eval/mean_reward",
          "eval/mean_ep_length", "eval/success_rate", "train/critic_loss", "train/actor_loss",
          "train/ent_coef", "train/ent_coef_loss", "train/n_updates"}) {
      ASSERT_TRUE(scalars.contains(tag)) << file << ": " << tag;
      for (const auto& [env_steps, value] : scalars.at(tag)) {
        EXPECT_GT(env_steps, reached[tag]) << file << ": " << tag;
        reached[tag] = env_steps;
      }
    }
  }
}

// Rewrites the build information in the run's files.
void MakeOfAnotherBuild(const std::filesystem::path& run) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(run)) {
    if (entry.path().extension() != ".json" || !entry.is_regular_file()) continue;
    auto file = nlohmann::json::parse(ReadFile(entry.path()));
    if (!file.is_object() || !file.contains("commit")) continue;
    file["commit"] = "0123456789ab";
    if (file.contains("commits")) file["commits"] = {"0123456789ab"};
    WriteFileAtomically(entry.path(), file.dump(1));
  }
}

// A newer build continues a run, and the run records this.
TEST(Resume, WithAFileTheReplayGoesOnWithItsContent) {
  const TrainingRun run;
  const ProgramResult first =
      run.Train({{"env_steps", "2500"}, {"eval.final_episodes", "0"}, {"replay.keep", "true"}});
  ASSERT_EQ(ExitCode(first), 0) << first.out << first.err;
  ExpectScalars(run.path(), 1);
  const auto before = run.Json("meta.json");
  MakeOfAnotherBuild(run.path());
  const ProgramResult resumed = Resume(run, "4000");
  ASSERT_EQ(ExitCode(resumed), 0) << resumed.out << resumed.err;
  ExpectScalars(run.path(), 2);
  const auto meta = run.Json("meta.json");
  ExpectBalanced(meta);
  EXPECT_EQ(meta.at("accounting").at("lost_with_process"), 0);
  EXPECT_GE(meta.at("env_steps").get<int64_t>(), 4000);
  EXPECT_GT(meta.at("updates").get<int64_t>(), before.at("updates").get<int64_t>());
  EXPECT_GT(before.at("cpu_seconds").get<double>(), 0);
  EXPECT_GT(meta.at("cpu_seconds").get<double>(), before.at("cpu_seconds").get<double>());
  EXPECT_EQ(resumed.out.find("refilled"), std::string::npos) << resumed.out;
  EXPECT_EQ(meta.at("commits"), nlohmann::json({"0123456789ab", before.at("commit")}));
  EXPECT_EQ(meta.at("commit"), before.at("commit"));
}

TEST(Resume, AFinishedRunStaysAsItIs) {
  const TrainingRun run;
  const ProgramResult first = run.Train({{"env_steps", "1500"}, {"eval.interval", "500"}});
  ASSERT_EQ(ExitCode(first), 0) << first.out << first.err;
  const std::string meta = ReadFile(run.path() / "meta.json");
  const ProgramResult again =
      RunProgram({"shoal", "train", "--resume", run.path()}, std::chrono::seconds(60));
  EXPECT_EQ(ExitCode(again), 2) << again.out;
  EXPECT_NE(again.err.find("is finished (budget at "), std::string::npos) << again.err;
  EXPECT_EQ(ReadFile(run.path() / "meta.json"), meta);

  const ProgramResult further = Resume(run, "1600");
  EXPECT_EQ(ExitCode(further), 0) << further.out << further.err;
  EXPECT_NE(further.out.find("  goes on at 15"), std::string::npos) << further.out;
  EXPECT_NE(further.out.find(", from " + (run.path() / "checkpoints/").string()), std::string::npos)
      << further.out;
}

TEST(Evaluation, OfARunIsOfTheCheckpointThatItIsJudgedBy) {
  const TrainingRun run;
  const ProgramResult first = run.Train({{"env_steps", "1500"}, {"eval.interval", "500"}});
  ASSERT_EQ(ExitCode(first), 0) << first.out << first.err;
  const auto evaluate = [&](const std::string& file) {
    return RunProgram(
        {"shoal", "eval", "--checkpoint", run.path(), "--episodes", "2", "--json", file},
        std::chrono::seconds(180));  // it may measure baselines
  };
  const ProgramResult good = evaluate(run.parent() / "x.json");
  ASSERT_EQ(ExitCode(good), 0) << good.err;
  const auto seed = nlohmann::json::parse(ReadFile(run.parent() / "x.json")).at("seeds").at(0);
  EXPECT_GE(seed.get<int64_t>(), 1'000'000'000) << "the run's own, not a number of everybody's";
  EXPECT_NE(good.out.find(fmt::format("2 episodes (seed {}) of {}", seed.dump(),
                                      (run.path() / "checkpoints/best").string())),
            std::string::npos)
      << good.out;
  EXPECT_NE(good.out.find(", length 50.0, final distance 0."), std::string::npos) << good.out;
  const ProgramResult nowhere = evaluate("/absent/x.json");
  EXPECT_EQ(ExitCode(nowhere), 1);
  EXPECT_NE(nowhere.err.find("'/absent/x.json'"), std::string::npos) << nowhere.err;
  EXPECT_EQ(nowhere.out, "") << "found out before anything was played";
}

TEST(Evaluation, InterruptedKeepsWhatWasPlayed) {
  const TrainingRun run;
  const ProgramResult first = run.Train({{"env_steps", "1500"}, {"eval.interval", "500"}});
  ASSERT_EQ(ExitCode(first), 0) << first.out << first.err;
  const std::filesystem::path file = run.parent() / "x.json";
  launch::ProcessSpec spec;
  spec.role = "test";
  spec.command = {ProgramPath("shoal"), "eval",   "--checkpoint", run.path(),
                  "--episodes",         "100000", "--json",       file};
  spec.output = run.parent() / "out";
  launch::ChildProcess eval(spec);
  const SteadyTime deadline = Now() + std::chrono::seconds(60);
  // `shoal eval` prints its progress.
  const auto plays = [&] {
    const std::string said = ReadFile(spec.output);
    return said.find("played ") != std::string::npos &&
           said.find(" of 100000 episodes\n") != std::string::npos;
  };
  while (!plays() && !eval.Poll() && Now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_TRUE(plays()) << ReadFile(spec.output);
  eval.Signal(SIGINT);
  while (!eval.Poll() && Now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  ASSERT_TRUE(eval.Poll());
  const std::string said = ReadFile(spec.output);
  EXPECT_EQ(eval.Poll()->Describe(), "killed by SIGINT") << said;
  const auto written = nlohmann::json::parse(ReadFile(file));
  EXPECT_EQ(written.at("episodes_asked"), 100'000);
  const size_t played = written.at("episodes").size();
  EXPECT_GT(played, 0u);
  EXPECT_LT(played, 100'000u);
  EXPECT_NE(said.find(fmt::format("{} episodes (seed ", played)), std::string::npos) << said;
  EXPECT_NE(said.find(fmt::format("partial: the first {} of 100000 episodes", played)),
            std::string::npos)
      << said;
}

}  // namespace
}  // namespace shoal
