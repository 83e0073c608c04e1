// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and other stop signals: the end of a program as seen by a shell or another parent.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <functional>
#include <thread>

#include "tests/support/processes.h"
#include "tests/support/run_views.h"
#include "tests/support/running_training.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::Not;

const TrainingRun::Keys kEndless{{"env_steps", "10000000"}, {"actors", "1"}};

std::string SaidIn(const fs::path& file) { return fs::exists(file) ? ReadFile(file) : ""; }

bool WaitUntilTrue(const std::function<bool()>& condition, seconds deadline) {
  const SteadyTime end = Now() + deadline;
  while (!condition()) {
    if (Now() > end) return false;
    std::this_thread::sleep_for(milliseconds(20));
  }
  return true;
}

std::string EndOf(launch::ChildProcess* child, seconds deadline) {
  // Not by its state in /proc: a process of several threads is a zombie there before it has ended.
  std::optional<launch::ExitStatus> status;
  const bool ended = WaitUntilTrue([&] { return (status = child->Poll()).has_value(); }, deadline);
  return ended ? status->Describe() : "still running";
}

// Whether the process has a handler for the signal by now.
bool Catches(pid_t pid, int signal) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("SigCgt:")) continue;
    return (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1) != 0;
  }
  return false;
}

std::string Words(const std::vector<std::string>& command) {
  std::string line;
  for (const std::string& word : command) line += "'" + word + "' ";
  return line;
}

// A loop over seeds in bash, written as in docs/results/reach-fast.md. As a terminal does on
// Ctrl-C, every process of its group gets SIGINT.
TEST(Interrupt, ALoopOfAShellEndsWithTheRun) {
  const TrainingRun run;
  std::vector<std::string> command = run.Command(kEndless);
  command[0] = ProgramPath("shoal");
  launch::ProcessSpec spec;
  spec.command = {"/bin/bash", "-c",
                  fmt::format("for s in 1 2 3; do {} --overwrite --seed $s; echo seed $s ended; "
                              "done; echo loop ended",
                              Words(command))};
  spec.output = run.parent() / "said";
  ReportReader reports(run.path());
  launch::ChildProcess bash(spec);
  ASSERT_FALSE(reports.Await("learner").is_null()) << ReadFile(spec.output);
  ASSERT_EQ(kill(-bash.pid(), SIGINT), 0);
  EXPECT_EQ(EndOf(&bash, seconds(60)), "killed by SIGINT") << ReadFile(spec.output);
  EXPECT_THAT(ReadFile(spec.output), HasSubstr("ended (interrupted)"));
  EXPECT_THAT(ReadFile(spec.output), Not(HasSubstr("ended\n")));
  EXPECT_EQ(run.Json("config.json").at("seed"), 1);
  ExpectBalanced(run.Json("meta.json"));
}

struct StopCase {
  std::string name;
  int signal;
};

void PrintTo(const StopCase& stop, std::ostream* out) { *out << stop.name; }

class DiesBy : public testing::TestWithParam<StopCase> {};

TEST_P(DiesBy, TheSignalThatEndsARunInOrder) {
  const TrainingRun run;
  launch::ProcessSpec spec;
  spec.command = run.Command(kEndless);
  spec.command[0] = ProgramPath("shoal");
  spec.output = run.parent() / "said";
  ReportReader reports(run.path());
  launch::ChildProcess training(spec);
  ASSERT_FALSE(reports.Await("learner").is_null()) << ReadFile(spec.output);
  training.Signal(GetParam().signal);
  EXPECT_EQ(EndOf(&training, seconds(60)), "killed by " + GetParam().name) << ReadFile(spec.output);
  EXPECT_EQ(run.Json("meta.json").at("exit"), "interrupted");
  ExpectBalanced(run.Json("meta.json"));
}

INSTANTIATE_TEST_SUITE_P(All, DiesBy,
                         testing::Values(StopCase{"SIGINT", SIGINT}, StopCase{"SIGTERM", SIGTERM},
                                         StopCase{"SIGHUP", SIGHUP}),
                         [](const auto& test) { return test.param.name; });

// Before there are handlers, while shoal-actor describes the observations, and later.
TEST(Interrupt, AtEveryMomentOfTheStartTheCommandDiesByTheSignal) {
  for (const int after_ms : {0, 10, 20, 40, 60, 80, 120, 200, 300}) {
    const TrainingRun run;
    launch::ProcessSpec spec;
    spec.command = run.Command(kEndless);
    spec.command[0] = ProgramPath("shoal");
    spec.output = run.parent() / "said";
    launch::ChildProcess training(spec);
    std::this_thread::sleep_for(milliseconds(after_ms));
    training.Signal(SIGINT);
    EXPECT_EQ(EndOf(&training, seconds(30)), "killed by SIGINT")
        << after_ms << " ms: " << ReadFile(spec.output);
  }
}

// The words of a command that runs until it is stopped, and its output after the start; empty if it
// prints nothing before its end.
struct CommandCase {
  std::string name;
  std::vector<std::string> words;
  std::string begun;
};

void PrintTo(const CommandCase& command, std::ostream* out) { *out << command.name; }

class StoppedCommand : public testing::TestWithParam<CommandCase> {};

TEST_P(StoppedCommand, DiesBySigint) {
  const TemporaryFolder folder;
  launch::ProcessSpec spec;
  spec.command = GetParam().words;
  spec.command[0] = ProgramPath(spec.command[0]);
  spec.output = folder.path() / "said";
  spec.environment = {{"XDG_CACHE_HOME", folder.path().string()}};
  launch::ChildProcess child(spec);
  const auto has_begun = [&] {
    return Catches(child.pid(), SIGINT) &&
           SaidIn(spec.output).find(GetParam().begun) != std::string::npos;
  };
  ASSERT_TRUE(WaitUntilTrue(has_begun, seconds(60))) << ReadFile(spec.output);
  child.Signal(SIGINT);
  EXPECT_EQ(EndOf(&child, seconds(30)), "killed by SIGINT") << ReadFile(spec.output);
}

INSTANTIATE_TEST_SUITE_P(
    All, StoppedCommand,
    testing::Values(
        CommandCase{"Web", {"shoal", "web", "--port", "0"}, "Ctrl-C ends the server"},
        CommandCase{"Observability",
                    {"shoal", "env", "observability", "FetchReach", "--tell", "grip", "--samples",
                     "40", "--updates", "100000", "--width", "32", "--height", "32"},
                    ""},
        CommandCase{
            "RandomPlay", {"shoal", "env", "random", "FetchReach", "--episodes", "1000000"}, ""},
        CommandCase{"Check", {"shoal", "check"}, "preset"}),
    [](const auto& test) { return test.param.name; });

TEST(Interrupt, TheProgramsOfARunDieByTheSignalThatEndsThem) {
  const TrainingRun run;
  RunningTraining training(run, run.Command(kEndless));
  const nlohmann::json view = WaitForView(run, [](const nlohmann::json& v) { return Learns(v); });
  ASSERT_TRUE(view.is_object());
  for (const char* role : {"actor", "eval"}) {
    const auto pid = ProcessOf(view, role).at("pid").get<pid_t>();
    ASSERT_EQ(kill(pid, SIGTERM), 0);
    EXPECT_TRUE(training.WaitForOutput(fmt::format("{}-0: killed by SIGTERM", role)))
        << training.Output();
  }
  training.Interrupt();
  EXPECT_EQ(training.End(seconds(60)), kInterruptedExit) << training.Output();
}

// Within a second: some actors have not begun when their stop arrives.
TEST(Interrupt, ManyOrdersToScaleAtOnceAreNoFailure) {
  const TrainingRun run;
  RunningTraining training(run, run.Command(kEndless));
  ASSERT_TRUE(WaitForView(run, Learns).is_object());
  std::vector<launch::ChildProcess> orders;
  for (int i = 0; i < 6; ++i) {
    launch::ProcessSpec spec;
    spec.command = {ProgramPath("shoal"), "scale", run.path().string(), i % 2 == 0 ? "4" : "1"};
    spec.output = run.parent() / fmt::format("order{}", i);
    orders.emplace_back(spec);
  }
  for (size_t i = 0; i < orders.size(); ++i) {
    EXPECT_EQ(EndOf(&orders[i], seconds(90)), "exit code 0")
        << ReadFile(run.parent() / fmt::format("order{}", i));
  }
  const ProgramResult last = RunShoal(run, {"scale", "1"});
  EXPECT_EQ(ExitCode(last), 0) << last.err;
  training.Interrupt();
  EXPECT_EQ(training.End(seconds(60)), kInterruptedExit) << training.Output();
  EXPECT_THAT(training.Output(), Not(HasSubstr("while stopping")));
  ExpectBalanced(run.Json("meta.json"));
}

// The evaluation at a run's end goes on for longer than a client waits for its answer.
TEST(Interrupt, WhileARunIsEvaluatedOrdersAreAnsweredAtOnce) {
  const TrainingRun run;
  TrainingRun::Keys keys = kEndless;
  keys["eval.final_episodes"] = "100000";
  RunningTraining training(run, run.Command(keys));
  ASSERT_TRUE(WaitForView(run, Learns).is_object());
  const ProgramResult budget = RunShoal(run, {"set", "env_steps=100"});
  EXPECT_EQ(ExitCode(budget), 0) << budget.err;
  ASSERT_TRUE(
      WaitForView(run, [](const nlohmann::json& view) { return view.at("state") == "evaluating"; })
          .is_object())
      << training.Output();
  const SteadyTime start = Now();
  const ProgramResult refused = RunShoal(run, {"set", "env_steps=100000"});
  EXPECT_EQ(ExitCode(refused), 1);
  EXPECT_THAT(refused.err, HasSubstr("training has ended and the run is being evaluated"));
  EXPECT_LT(SecondsSince(start), 5);
  const ProgramResult stop = RunShoal(run, {"stop"});
  EXPECT_EQ(ExitCode(stop), 0) << stop.out << stop.err;
  EXPECT_EQ(training.End(seconds(30)), 0) << training.Output();
  EXPECT_THAT(training.Output(), HasSubstr("the evaluation was skipped"));
}

}  // namespace
}  // namespace shoal
