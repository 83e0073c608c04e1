// SPDX-License-Identifier: Apache-2.0
// Runs of PPO through the real programs: no replay, rollouts to the learner, an exact account.
#include <gtest/gtest.h>
#include <signal.h>

#include "tests/support/running_training.h"

namespace shoal {
namespace {

using nlohmann::json;
using std::chrono::seconds;

int64_t Updates(const json& report) { return report.at("updates").get<int64_t>(); }

// By the learner, which counts them: there is no replay to.
bool WaitForMoreUpdates(RunningTraining* training, int64_t updates) {
  const json now = training->reports().Await("learner");
  if (now.is_null()) return false;
  const int64_t wanted = Updates(now) + updates;
  return !training->reports()
              .WaitFor(
                  "learner", [&](const json& r) { return Updates(r) >= wanted; }, seconds(120))
              .is_null();
}

TEST(OnPolicy, ARunOfWholeRolloutsHasNoReplayAndAnExactAccount) {
  const TrainingRun run;
  const ProgramResult result =
      RunProgram(run.OnPolicyCommand({{"env_steps", "8000"}}), seconds(180));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  EXPECT_EQ(result.out.find("1 replay"), std::string::npos) << result.out;
  EXPECT_FALSE(std::filesystem::exists(run.path() / "replay.ring"));
  EXPECT_FALSE(std::filesystem::exists(run.path() / "logs" / "replay-0.log"));
  const json meta = run.Json("meta.json");
  ExpectBalanced(meta);
  EXPECT_EQ(meta.at("env_steps"), 8 * 1024) << "the budget, in whole rollouts of 2 x 4 x 128";
  EXPECT_EQ(meta.at("updates"), 8);
  EXPECT_EQ(meta.at("accounting").at("discarded"), 0) << "no actor plays beyond the budget";
  const ProgramResult replay = RunProgram({"shoal-replay", "--run", run.path()}, seconds(30));
  EXPECT_EQ(ExitCode(replay), 2) << replay.err;
  EXPECT_NE(replay.err.find("has no replay: learner.algorithm = ppo"), std::string::npos)
      << replay.err;
}

TEST(OnPolicy, InLockstepTheRunRepeatsBitForBit) {
  const auto learner = [](const std::string& seed) {
    const TrainingRun run;
    const ProgramResult result = RunProgram(
        run.OnPolicyCommand(
            {{"env_steps", "2500"}, {"actors", "1"}, {"eval.interval", "1000"}, {"seed", seed}},
            {"--lockstep"}),
        seconds(180));
    EXPECT_EQ(ExitCode(result), 0) << result.out << result.err;
    std::filesystem::path newest;
    for (const auto& entry : std::filesystem::directory_iterator(run.path() / "checkpoints")) {
      if (entry.path().filename() != "best") newest = std::max(newest, entry.path());
    }
    return ReadFile(newest / "learner.safetensors");
  };
  const std::string one = learner("1");
  EXPECT_TRUE(one == learner("1")) << "the same seed, other parameters";
  EXPECT_FALSE(one == learner("2")) << "another seed, the same parameters";
}

TEST(OnPolicy, OneVersionAheadActorsPlayWhileTheLearnerLearns) {
  const TrainingRun run;
  const ProgramResult result = RunProgram(
      run.OnPolicyCommand({{"env_steps", "12000"}, {"ppo.versions_ahead", "1"}}), seconds(180));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  const json meta = run.Json("meta.json");
  EXPECT_EQ(meta.at("exit"), "budget");
  ExpectBalanced(meta);
}

// An actor that stands still does not hold the others up for longer than the deadline.
TEST(OnPolicy, WithoutAnActorThatHangsUpdatesAreMadeOfTheOtherHalf) {
  const TrainingRun run;
  RunningTraining training(run, run.OnPolicyCommand({{"env_steps", "10000000"},
                                                     {"eval.interval", "1000000"},
                                                     {"ppo.rollout_deadline", "1"}}));
  ASSERT_TRUE(WaitForMoreUpdates(&training, 2)) << training.Output();
  const json actor = training.reports().WaitFor("actor", [](const json&) { return true; });
  ASSERT_FALSE(actor.is_null());
  const pid_t victim = actor.at("pid").get<pid_t>();
  ASSERT_EQ(kill(victim, SIGSTOP), 0);
  ASSERT_TRUE(WaitForMoreUpdates(&training, 3)) << training.Output();
  const json late = training.reports().WaitFor(
      "learner", [](const json& r) { return r.at("rollouts_late").get<double>() >= 4; });
  EXPECT_FALSE(late.is_null()) << "an update of all four other environments is said to be short";
  ASSERT_EQ(kill(victim, SIGCONT), 0);
  const int64_t then = late.is_null() ? 0 : Updates(late);
  EXPECT_FALSE(training.reports()
                   .WaitFor(
                       "learner",
                       [&](const json& r) {
                         return Updates(r) > then + 3 && r.at("rollout_steps") == 8 * 128;
                       },
                       seconds(60))
                   .is_null())
      << "it joins again";
  training.Interrupt();
  ASSERT_EQ(training.End(seconds(120)), kInterruptedExit) << training.Output();
  ExpectBalanced(run.Json("meta.json"));
}

TEST(OnPolicy, WhatDoesNotFitIsRefusedByName) {
  const TrainingRun run;
  const std::pair<TrainingRun::Keys, const char*> cases[] = {
      {{{"replay.n_step", "3"}}, "replay.n_step = 3: learner.algorithm = ppo"},
      {{{"replay.hindsight", "future"}}, "replay.hindsight"},
      {{{"ppo.rollout_steps", "100"}}, "ppo.rollout_steps = 100"},
      {{{"ppo.rollout_steps", "1"}}, "ppo.rollout_steps = 1"}};
  for (const auto& [keys, message] : cases) {
    const ProgramResult result = RunProgram(run.OnPolicyCommand(keys), seconds(60));
    EXPECT_EQ(ExitCode(result), 2);
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(run.path()));
  }
}

}  // namespace
}  // namespace shoal
