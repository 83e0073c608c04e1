// SPDX-License-Identifier: Apache-2.0
// `shoal train --in-process`: all roles as threads of one process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "tests/support/running_training.h"
#include "tests/support/training_run.h"

namespace shoal {
namespace {

using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(InProcess, ALockstepRunLeavesTheBytesOfOneInProcesses) {
  const TrainingRun::Keys keys{{"env_steps", "1200"}, {"eval.interval", "600"}, {"actors", "1"}};
  const TrainingRun processes, threads;
  const ProgramResult first = processes.Train(keys, {"--lockstep"});
  ASSERT_EQ(ExitCode(first), 0) << first.out << first.err;
  const ProgramResult second = threads.Train(keys, {"--lockstep", "--in-process"});
  ASSERT_EQ(ExitCode(second), 0) << second.out << second.err;
  EXPECT_TRUE(NewestLearnerState(processes) == NewestLearnerState(threads))
      << "learner.safetensors differs";
  EXPECT_EQ(processes.Json("meta.json").at("updates"), threads.Json("meta.json").at("updates"));
  ExpectBalanced(threads.Json("meta.json"));
  for (const char* role : {"actor-0", "eval-0", "learner-0", "replay-0"}) {
    const std::string log = ReadFile(threads.path() / "logs" / (std::string(role) + ".log"));
    EXPECT_THAT(log, HasSubstr(std::string(role) + " info: ")) << role;
  }
}

TEST(InProcess, SeveralActorsLearnPixelsAndTheAccountBalances) {
  const TrainingRun run;
  const ProgramResult result =
      run.Train(TrainingRun::FromPixels({{"actors", "3"}, {"env_steps", "800"}}),
                {"--in-process", "--preset", "fetch-reach-drq"});
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  const auto meta = run.Json("meta.json");
  ExpectBalanced(meta);
  EXPECT_GE(meta.at("env_steps").get<int64_t>(), 800);
  EXPECT_GT(meta.at("updates").get<int64_t>(), 50);
  EXPECT_EQ(meta.at("restarts"), 0);
}

TEST(InProcess, CtrlCEndsItInOrderAndProcessesGoOn) {
  const TrainingRun run;
  {
    RunningTraining training(run, run.Command({{"env_steps", "1000000"}}, {"--in-process"}));
    ASSERT_TRUE(training.WaitForSteps(1500)) << training.Output();
    training.Interrupt();
    ASSERT_EQ(training.End(seconds(60)), kInterruptedExit) << training.Output();
  }
  ExpectBalanced(run.Json("meta.json"));
  const int64_t before = run.Json("meta.json").at("env_steps").get<int64_t>();
  const ProgramResult resumed = RunProgram({"shoal", "train", "--resume", run.path().string(),
                                            "--set", "env_steps=" + std::to_string(before + 1000)},
                                           seconds(120));
  ASSERT_EQ(ExitCode(resumed), 0) << resumed.out << resumed.err;
  ExpectBalanced(run.Json("meta.json"));
  EXPECT_GE(run.Json("meta.json").at("env_steps").get<int64_t>(), before + 1000);
}

TEST(InProcess, AnActorThatFailsIsRestartedAndSaysWhy) {
  const TrainingRun run;
  RunningTraining training(
      run, run.Command({{"env_steps", "1000000"}, {"actors", "2"}}, {"--in-process"}));
  ASSERT_TRUE(training.WaitForSteps(1000)) << training.Output();
  // The session file contains no number when the actor is started again.
  WriteFileAtomically(run.path() / "sessions" / "actor-1", "damaged");
  const ProgramResult scaled =
      RunProgram({"shoal", "scale", "--run", run.path().string(), "1"}, seconds(20));
  ASSERT_EQ(ExitCode(scaled), 0) << scaled.out << scaled.err;
  launch::ProcessSpec scale;  // which waits for the actor to work
  scale.role = "scale";
  scale.command = {ProgramPath("shoal"), "scale", "--run", run.path().string(), "2"};
  scale.output = run.parent() / "scale.log";
  const launch::ChildProcess again(scale);
  ASSERT_TRUE(training.WaitForOutput("actor-1: exit code")) << training.Output();
  // Otherwise the actor may fail once more while the run stops, and the run would end with code 1.
  std::filesystem::remove(run.path() / "sessions" / "actor-1");
  ASSERT_TRUE(training.WaitForMoreSteps(200)) << training.Output();
  training.Interrupt();
  ASSERT_EQ(training.End(seconds(60)), kInterruptedExit) << training.Output();
  EXPECT_THAT(training.Output(),
              AllOf(HasSubstr("actor-1: exit code 2: shoal-actor: error: "), HasSubstr("restart")));
  ExpectBalanced(run.Json("meta.json"));
}

TEST(InProcess, WhatThreadsCannotHaveIsRefusedByName) {
  const TrainingRun run;
  const ProgramResult secured =
      run.Train({}, {"--in-process", "--secure", run.parent().string()}, seconds(20));
  EXPECT_EQ(ExitCode(secured), 2);
  EXPECT_THAT(secured.err, HasSubstr("--in-process: not with a secured run (--secure)"));
  const ProgramResult hosts = run.Train({}, {"--in-process", "--hosts", "hosts.json"}, seconds(20));
  EXPECT_EQ(ExitCode(hosts), 2);
  EXPECT_THAT(hosts.err, HasSubstr("--in-process: not with other hosts (--hosts)"));
  EXPECT_FALSE(std::filesystem::exists(run.path()));
}

TEST(InProcess, TheBreakpointsOfTheDebuggersScriptAreFunctionsOfTheProgram) {
  const ProgramResult symbols = RunCommand(
      {"/usr/bin/nm", "--demangle", "--defined-only", ProgramPath("shoal")}, seconds(60));
  ASSERT_EQ(ExitCode(symbols), 0) << symbols.err;
  std::istringstream script(ReadFile(SourcePath("docs/examples/follow_one_transition.gdb")));
  int breakpoints = 0;
  for (std::string word; script >> word;) {
    if (word != "tbreak") continue;
    script >> word;
    ++breakpoints;
    EXPECT_THAT(symbols.out, HasSubstr(" " + word + "(")) << word;
  }
  EXPECT_EQ(breakpoints, 8);
}

}  // namespace
}  // namespace shoal
