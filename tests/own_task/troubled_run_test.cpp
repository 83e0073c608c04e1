// SPDX-License-Identifier: Apache-2.0
// Whole runs of faulty tasks (tests/own_task/troubled).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/support/paths.h"
#include "tests/support/program.h"

namespace shoal {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class TroubledRun : public testing::Test {
 protected:
  std::filesystem::path run() const { return folder_.path() / "run"; }

  // From state, with two environments, unless `more` says otherwise.
  ProgramResult Train(const std::string& task, std::vector<std::string> more = {}) {
    std::vector<std::string> command{"shoal", "train", "--run-name", "run"};
    std::vector<std::string> keys{"run_dir=" + folder_.path().string(),
                                  "task_library=" + ProgramPath("troubled.so"),
                                  "task=" + task,
                                  "env_steps=3000",
                                  "actors=1",
                                  "envs_per_actor=2",
                                  "observation.pixels=false",
                                  "observation.goal_mode=desired",
                                  "network.hidden=[16,16]",
                                  "learner.batch=16",
                                  "learner.threads=1",
                                  "replay.min_size=100",
                                  "replay.capacity=5000",
                                  "replay.samples_per_insert=2",
                                  "eval.episodes=40",
                                  "eval.interval=1500",
                                  "eval.final_episodes=60",
                                  "stop.success=2"};
    if (std::ranges::find(more, "learner.algorithm=ppo") != more.end()) {  // it has no replay
      std::erase_if(keys, [](const std::string& key) { return key.starts_with("replay."); });
    }
    for (const std::string& key : more) {
      const std::string start = key.substr(0, key.find('=') + 1);
      std::erase_if(keys, [&](const std::string& known) { return known.starts_with(start); });
      keys.push_back(key);
    }
    for (const std::string& key : keys) command.insert(command.end(), {"--set", key});
    return RunProgram(command, std::chrono::seconds(200));
  }
  json Read(const char* file) const { return json::parse(ReadFile(run() / file)); }
  // All made records are stored, and as many steps as the run asked for.
  void ExpectBalance() const {
    const json accounting = Read("meta.json").at("accounting");
    EXPECT_TRUE(accounting.at("balances").get<bool>()) << accounting.dump();
    EXPECT_EQ(accounting.at("made"), accounting.at("stored")) << accounting.dump();
  }

  const TemporaryFolder folder_;
};

TEST_F(TroubledRun, AFaultyEpisodeDoesNotEndTheRunAndIsCounted) {
  for (const char* task : {"TroubledSensor", "TroubledDiverged", "TroubledReset"}) {
    const ProgramResult result = Train(task);
    ASSERT_EQ(ExitCode(result), 0) << task << result.out << result.err;
    const json meta = Read("meta.json");
    EXPECT_EQ(meta.at("exit"), "budget");
    uint64_t counted = 0;
    for (const auto& [cause, count] : meta.at("faulty_episodes").items()) {
      EXPECT_EQ(cause, std::string(task) == "TroubledDiverged" ? "diverged" : "observation");
      counted += count.get<uint64_t>();
    }
    EXPECT_GT(counted, 0u) << task;
    EXPECT_THAT(result.out, HasSubstr("faulty episodes of the actors, ended where a number was not "
                                      "finite: " +
                                      std::to_string(counted)));
    EXPECT_GE(meta.at("env_steps"), 3000);
    ExpectBalance();
    const json final_evaluation = Read("eval/final.json");
    if (final_evaluation.at("aggregate").contains("faulty_episodes")) {
      EXPECT_THAT(result.out, HasSubstr(" faulty episodes"));
    }
    EXPECT_THAT(ReadFile(run() / "logs" / "actor-0.log"),
                HasSubstr("the episode ends there, truncated"));
    std::filesystem::remove_all(run());
  }
}

TEST_F(TroubledRun, WithHindsightOrOnPolicyItGoesOnAsWell) {
  ProgramResult result = Train("TroubledSensor", {"replay.hindsight=future"});
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  ExpectBalance();
  std::filesystem::remove_all(run());
  // A rollout that lacked a step would be waited for until its deadline.
  result =
      Train("TroubledSensor", {"learner.algorithm=ppo", "ppo.rollout_steps=128", "learner.batch=64",
                               "ppo.rollout_deadline=60", "ppo.epochs=2", "env_steps=4096"});
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  const json meta = Read("meta.json");
  EXPECT_FALSE(meta.at("faulty_episodes").empty());
  EXPECT_LT(meta.at("wall_seconds"), 50) << "no update waited";
  EXPECT_EQ(meta.at("updates"), 16);
  EXPECT_TRUE(meta.at("accounting").at("balances").get<bool>());
}

// Lockstep ends with the same bytes also after faults.
TEST_F(TroubledRun, InLockstepItRepeats) {
  std::vector<std::string> policies;
  for (int i = 0; i < 2; ++i) {
    const ProgramResult result =
        Train("TroubledSensor", {"lockstep=true", "env_steps=1600", "eval.final_episodes=0"});
    ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
    EXPECT_FALSE(Read("meta.json").at("faulty_episodes").empty());
    ExpectBalance();
    std::string newest;
    for (const auto& entry : std::filesystem::directory_iterator(run() / "checkpoints")) {
      if (entry.path().filename() == "best") continue;
      newest = std::max(newest, entry.path().string());
    }
    policies.push_back(ReadFile(std::filesystem::path(newest) / "policy.safetensors"));
    std::filesystem::remove_all(run());
  }
  EXPECT_EQ(policies[0], policies[1]);
}

TEST_F(TroubledRun, WhereFaultsAreNoExceptionTheRunEndsWithTheirLine) {
  const ProgramResult result = Train("TroubledAlways");
  EXPECT_EQ(ExitCode(result), 1) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("y of block 'position' is nan after 6 control steps"));
  EXPECT_THAT(result.out, HasSubstr("episodes ended so (max_faulty_share = 0.05)"));
  EXPECT_EQ(Read("meta.json").at("exit"), "failed");
}

TEST_F(TroubledRun, WithAShareOfZeroTheFirstFaultEndsTheRun) {
  const ProgramResult result = Train("TroubledSensor", {"max_faulty_share=0"});
  EXPECT_EQ(ExitCode(result), 1) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("y of block 'position' is nan after 6 control steps"));
}

TEST_F(TroubledRun, AWrongBlockSizeIsRefusedBeforeAnythingStarts) {
  const ProgramResult result = Train("TroubledLong");
  EXPECT_EQ(ExitCode(result), 2);
  EXPECT_THAT(result.err, HasSubstr("task TroubledLong: block 'velocity' has 2 numbers in the goal "
                                    "half, Observe wrote 3"));
  EXPECT_FALSE(std::filesystem::exists(run()));
}

TEST_F(TroubledRun, ATaskThatPrintsIsTrainedAndEvaluated) {
  setenv("TROUBLED_TALK", "1", 1);
  const ProgramResult result = Train("TroubledTalk", {"env_steps=600", "eval.final_episodes=10"});
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  EXPECT_THAT(ReadFile(run() / "logs" / "actor-0.log"), HasSubstr("hello from a robot driver"));
  const ProgramResult eval =
      RunProgram({"shoal", "eval", "--checkpoint", run().string(), "--episodes", "5"},
                 std::chrono::seconds(60));
  unsetenv("TROUBLED_TALK");
  EXPECT_EQ(ExitCode(eval), 0) << eval.err;
  EXPECT_THAT(eval.out, HasSubstr("5 episodes (seed "));
  EXPECT_THAT(eval.err, Not(HasSubstr("played hello")));
}

TEST_F(TroubledRun, FromPixelsWithoutCamerasNamedTheFirstLinesSayWhich) {
  const ProgramResult result = Train(
      "TroubledCamera", {"env_steps=200", "observation.pixels=true", "observation.height=24",
                         "observation.width=24", "network.filters=[4,4]", "network.strides=[2,1]",
                         "replay.shift_pad=0", "eval.final_episodes=0"});
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("TroubledCamera has no cameras front and side: the policy sees "
                                    "through overhead, the task's first (observation.cameras)"));
  EXPECT_EQ(Read("config.json").at("observation").at("cameras"),
            std::vector<std::string>{"overhead"});
}

constexpr char kModel[] = R"(
<mujoco model="point">
  <option timestep="0.02"/>
  <worldbody>
    <light pos="0 0 2"/>
    <body name="point" pos="0 0 0.04">
      <joint name="x" type="slide" axis="1 0 0" damping="DAMPING"/>
      <joint name="y" type="slide" axis="0 1 0" damping="1"/>
      <geom type="sphere" size="0.04" mass="0.1" contype="0" conaffinity="0"/>
    </body>
  </worldbody>
  <actuator><motor joint="x"/><motor joint="y"/></actuator>
</mujoco>)";

std::string ModelWith(const std::string& damping) {
  std::string text = kModel;
  return text.replace(text.find("DAMPING"), 7, damping);
}

// Relative to the folder that the run was started from.
TEST_F(TroubledRun, ARelativeModelIsFoundFromAnyFolderAndAChangedOneIsNamed) {
  const std::filesystem::path model = folder_.path() / "point.xml";
  WriteFileAtomically(model, ModelWith("1"));
  const std::string relative = std::filesystem::relative(model);
  ASSERT_TRUE(std::filesystem::path(relative).is_relative());
  const ProgramResult result =
      Train("TroubledTalk", {"model=" + relative, "env_steps=300", "eval.final_episodes=0"});
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  EXPECT_EQ(Read("config.json").at("model").get<std::string>(),
            std::filesystem::absolute(relative).lexically_normal().string());
  const std::filesystem::path here = std::filesystem::current_path();
  std::filesystem::current_path("/");
  const auto eval = [&] {
    return RunProgram({"shoal", "eval", "--checkpoint", run().string(), "--episodes", "3"},
                      std::chrono::seconds(60));
  };
  const ProgramResult good = eval();
  WriteFileAtomically(model, ModelWith("2"));
  const ProgramResult bad = eval();
  const ProgramResult resumed =
      RunProgram({"shoal", "train", "--resume", run().string(), "--set", "env_steps=600"},
                 std::chrono::seconds(60));
  std::filesystem::current_path(here);
  EXPECT_EQ(ExitCode(good), 0) << good.err;
  const std::string line = "model file '" + std::filesystem::canonical(model).string() +
                           "' has changed since the run began";
  EXPECT_NE(ExitCode(bad), 0);
  EXPECT_THAT(bad.err, HasSubstr(line));
  EXPECT_NE(ExitCode(resumed), 0);
  EXPECT_THAT(resumed.err, HasSubstr(line));
}

}  // namespace
}  // namespace shoal
