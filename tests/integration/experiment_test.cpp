// SPDX-License-Identifier: Apache-2.0
// `shoal experiment run` with real, tiny runs: to the end, past a failure, after kills, in order on
// Ctrl-C.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "common/base/clock.h"
#include "common/base/usable_cores.h"
#include "tests/support/paths.h"
#include "tests/support/processes.h"
#include "tests/support/program.h"
#include "tests/support/tiny_experiment.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class ExperimentTest : public testing::Test {
 protected:
  void Define(const json& more = json::object(), int64_t env_steps = 1200) const {
    WriteFileAtomically(file_, TinyExperiment(more, env_steps).dump());
  }
  std::vector<std::string> Command(const std::vector<std::string>& flags = {}) const {
    std::vector<std::string> command{"shoal", "experiment", "run", file_, "--out", out_};
    command.insert(command.end(), flags.begin(), flags.end());
    return command;
  }
  ProgramResult Run(const std::vector<std::string>& flags = {}) const {
    return RunProgram(Command(flags), seconds(400));
  }
  ProgramResult SubmitWithoutSlurm() const {
    std::vector<std::string> command = Command({"--slurm"});
    command[0] = ProgramPath("shoal");
    return RunCommand(command, seconds(120), {{"PATH", "/nowhere"}});
  }
  launch::ChildProcess Start() const {
    launch::ProcessSpec spec;
    spec.command = Command();
    spec.command[0] = ProgramPath("shoal");
    spec.output = folder_.path() / "said";
    return launch::ChildProcess(spec);
  }
  // Waits until the run's reports show this number of stored steps.
  bool WaitForSteps(const std::string& run, int64_t env_steps) const {
    for (const SteadyTime end = Now() + seconds(90); Now() < end;) {
      if (fs::exists(out_ / "runs" / run / "metrics.jsonl")) {
        std::istringstream lines(ReadFile(out_ / "runs" / run / "metrics.jsonl"));
        for (std::string line; std::getline(lines, line);) {
          const json report = json::parse(line, nullptr, false);
          if (report.is_object() && report.value("stored_steps", 0.0) >= double(env_steps)) {
            return true;
          }
        }
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
  }
  json Read(const fs::path& file) const { return json::parse(ReadFile(out_ / file)); }
  std::vector<std::string> Statuses() const {
    std::vector<std::string> statuses;
    const json summary = Read("summary.json");
    for (const json& arm : summary.at("arms")) {
      for (const json& run : arm.at("runs")) statuses.push_back(run.at("status"));
    }
    return statuses;
  }

  const TemporaryFolder folder_;
  const fs::path file_ = folder_.path() / "mine.json", out_ = folder_.path() / "out";
};

std::vector<json> JsonLines(const std::string& text) {
  std::vector<json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(json::parse(line));
  return lines;
}

TEST_F(ExperimentTest, WhatIsFinishedIsNotRepeated) {
  Define({{"transfer", {"FetchReach"}}});
  const ProgramResult one = Run({"--arms", "b"});
  ASSERT_EQ(ExitCode(one), 0) << one.out << one.err;
  ASSERT_EQ(JsonLines(one.out).size(), 1u);
  EXPECT_THAT(Statuses(), ElementsAre("missing", "finished"));
  const ProgramResult first = Run();
  ASSERT_EQ(ExitCode(first), 0) << first.out << first.err;
  const std::vector<json> lines = JsonLines(first.out);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[1].at("run"), "b-s0");
  EXPECT_EQ(lines[1].at("status"), "finished");
  EXPECT_TRUE(lines[1].at("objective").is_number());
  EXPECT_TRUE(fs::is_directory(lines[1].at("path").get<std::string>()));
  const json summary = Read("summary.json");
  EXPECT_EQ(summary.at("arms").at(0).at("success").at("episodes"), 4);
  EXPECT_EQ(summary.at("arms").at(1).at("runs").at(0).at("transfer").at(0).at("task"),
            "FetchReach");
  EXPECT_EQ(Read("runs/b-s0/config.json").at("learner").at("batch"), 64);
  EXPECT_EQ(Read("runs/b-s0/meta.json").at("preset"), "fetch-reach-state");

  const std::string log = ReadFile(out_ / "runs.jsonl");
  const auto written = fs::last_write_time(out_ / "runs/a-s0/meta.json");
  const ProgramResult again = Run();
  EXPECT_EQ(ExitCode(again), 0) << again.err;
  EXPECT_EQ(JsonLines(again.out).size(), 2u);
  EXPECT_EQ(ReadFile(out_ / "runs.jsonl"), log) << "nothing was started";
  EXPECT_EQ(fs::last_write_time(out_ / "runs/a-s0/meta.json"), written);
}

TEST_F(ExperimentTest, AFailedRunIsSaidAndPassed) {
  Define(
      {{"arms", {{{"name", "a"}, {"set", {{"transport.interface", "eth77"}}}}, {{"name", "b"}}}}});
  const ProgramResult first = Run();
  EXPECT_EQ(ExitCode(first), 1) << first.err;
  EXPECT_THAT(first.err, HasSubstr("eth77"));
  EXPECT_THAT(Statuses(), ElementsAre("failed", "finished"));
  EXPECT_THAT(
      Read("summary.json").at("arms").at(0).at("runs").at(0).at("problem"),
      testing::ResultOf([](const json& j) { return j.get<std::string>(); }, HasSubstr("eth77")));
  const ProgramResult again = Run();
  EXPECT_EQ(ExitCode(again), 1);
  EXPECT_THAT(again.err, HasSubstr("--retry-failed"));
  EXPECT_THAT(Statuses(), ElementsAre("failed", "finished"));
}

TEST_F(ExperimentTest, AfterAKillItGoesOn) {
  Define(json::object(), 6000);
  {
    launch::ChildProcess killed = Start();
    ASSERT_TRUE(WaitForSteps("a-s0", 1500)) << ReadFile(folder_.path() / "said");
    killed.Signal(SIGKILL);
    ASSERT_TRUE(WaitUntilEnded(killed.pid(), seconds(10)));
  }
  const ProgramResult again = Run();
  ASSERT_EQ(ExitCode(again), 0) << again.out << again.err;
  EXPECT_THAT(Statuses(), ElementsAre("finished", "finished"));
  EXPECT_THAT(ReadFile(out_ / "runs.jsonl"), HasSubstr("\"resumed\":true"));
  const json meta = Read("runs/a-s0/meta.json");
  EXPECT_TRUE(meta.at("accounting").at("balances")) << meta.dump(1);
  EXPECT_GE(meta.at("env_steps").get<int64_t>(), 6000);
  EXPECT_EQ(meta.at("commits").size(), 1u);
}

TEST_F(ExperimentTest, CtrlCEndsInOrder) {
  Define(json::object(), 100'000);
  launch::ChildProcess child = Start();
  ASSERT_TRUE(WaitForSteps("a-s0", 500)) << ReadFile(folder_.path() / "said");
  const ProgramResult second = Run();
  EXPECT_EQ(ExitCode(second), 2);
  EXPECT_THAT(second.err, HasSubstr("is being run"));
  child.Signal(SIGINT);
  ASSERT_TRUE(WaitUntilEnded(child.pid(), seconds(120)));
  EXPECT_EQ(child.Poll()->Describe(), "killed by SIGINT");
  EXPECT_THAT(Statuses(), ElementsAre("interrupted", "missing"));
  EXPECT_EQ(Read("runs/a-s0/meta.json").at("exit"), "interrupted");
  const ProgramResult status =
      RunProgram({"shoal", "experiment", "status", out_.string()}, seconds(30));
  EXPECT_THAT(status.out, HasSubstr("no command is running it"));
}

TEST_F(ExperimentTest, CtrlCWhileBaselinesAreMeasuredIsAStopLikeAnyOther) {
  Define();
  setenv("XDG_CACHE_HOME", (folder_.path() / "cache").c_str(), 1);  // none has been measured
  launch::ChildProcess child = Start();
  unsetenv("XDG_CACHE_HOME");
  const SteadyTime end = Now() + seconds(60);
  while (ReadFile(folder_.path() / "said").find("measuring") == std::string::npos) {
    ASSERT_LT(Now(), end) << ReadFile(folder_.path() / "said");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  child.Signal(SIGINT);
  ASSERT_TRUE(WaitUntilEnded(child.pid(), seconds(60)));
  EXPECT_EQ(child.Poll()->Describe(), "killed by SIGINT") << ReadFile(folder_.path() / "said");
  EXPECT_THAT(Statuses(), ElementsAre("missing", "missing"));
}

TEST_F(ExperimentTest, ADryRunChecksTheFolderAndMakesNothing) {
  Define();
  EXPECT_EQ(ExitCode(Run({"--dry-run"})), 0);
  EXPECT_FALSE(fs::exists(out_));
  fs::create_directories(out_);
  WriteFileAtomically(out_ / "thesis.tex", "years of work");
  const ProgramResult refused = Run({"--dry-run"});
  EXPECT_EQ(ExitCode(refused), 2);
  EXPECT_THAT(refused.err, HasSubstr("something else"));
  EXPECT_EQ(std::distance(fs::directory_iterator(out_), fs::directory_iterator()), 1);
}

TEST_F(ExperimentTest, RunsSideBySideHaveTheirOwnCoresAndAreMarked) {
  if (UsableCores() < 2) GTEST_SKIP() << "needs two cores";
  Define();
  const ProgramResult result = Run({"--jobs", "2"});
  ASSERT_EQ(ExitCode(result), 0) << result.err;
  std::set<int> cores;
  for (const std::string& line : {std::string("a"), std::string("b")}) {
    EXPECT_EQ(Read("runs/" + line + "-s0/config.json").at("actors"), 1);
  }
  std::istringstream lines(ReadFile(out_ / "runs.jsonl"));
  for (std::string line; std::getline(lines, line);) {
    const json event = json::parse(line);
    if (event.at("event") != "started") continue;
    EXPECT_EQ(event.at("jobs"), 2);
    for (const int core : event.at("cores")) {
      EXPECT_TRUE(cores.insert(core).second) << "core " << core << " was given to both";
    }
  }
  const json summary = Read("summary.json");
  EXPECT_EQ(summary.at("arms").at(0).at("runs").at(0).at("beside_others"), true);
  EXPECT_LT(summary.at("arms").at(0).at("runs").at(0).at("cores").get<int>(), UsableCores());
}

TEST_F(ExperimentTest, WithoutSlurmAnArrayIsRefused) {
  Define();
  const ProgramResult refused = SubmitWithoutSlurm();
  EXPECT_EQ(ExitCode(refused), 1) << refused.err;
  EXPECT_THAT(refused.err, HasSubstr("sbatch"));
  EXPECT_FALSE(fs::exists(out_ / "slurm.json"));
  EXPECT_THAT(Statuses(), ElementsAre("missing", "missing"));
}

TEST_F(ExperimentTest, ATaskDoesOneRunBesideOthersAndNoneThatIsNotThere) {
  Define();
  SubmitWithoutSlurm();  // makes the folder
  const auto task = [&](const std::string& run) {
    return RunProgram({"shoal", "experiment", "task", out_, run, "--side-by-side", "2"},
                      seconds(200));
  };
  const ProgramResult b = task("b-s0");
  ASSERT_EQ(ExitCode(b), 0) << b.err;
  EXPECT_EQ(JsonLines(b.out).at(0).at("run"), "b-s0");
  EXPECT_THAT(Statuses(), ElementsAre("missing", "finished"));
  EXPECT_EQ(Read("summary.json").at("arms").at(1).at("runs").at(0).at("beside_others"), true);
  const ProgramResult none = task("c-s0");
  EXPECT_EQ(ExitCode(none), 2);
  EXPECT_THAT(none.err, HasSubstr("no run 'c-s0', expected one of a-sSEED, b-sSEED"));
}

struct Mistake {
  std::string name;
  json more;
  std::vector<std::string> flags;
  int exit_code;
  std::vector<std::string> mentions;
};

class ExperimentMistakes : public ExperimentTest, public testing::WithParamInterface<Mistake> {};

TEST_P(ExperimentMistakes, GetOneLineAndLeaveNothing) {
  Define(GetParam().more);
  const ProgramResult result = Run(GetParam().flags);
  EXPECT_EQ(ExitCode(result), GetParam().exit_code) << result.out << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  for (const std::string& word : GetParam().mentions) EXPECT_THAT(result.err, HasSubstr(word));
  EXPECT_FALSE(fs::exists(out_));
}

INSTANTIATE_TEST_SUITE_P(
    All, ExperimentMistakes,
    testing::Values(
        Mistake{"UnknownKey",
                {{"arms", {{{"name", "a"}, {"set", {{"learner.bach", 3}}}}}}},
                {},
                2,
                {"arm 'a'", "learner.bach", "learner.batch"}},
        Mistake{"UnknownPreset", {{"base", "nope"}}, {}, 2, {"nope", "fetch-reach-state"}},
        Mistake{"UnknownCamera",
                {{"arms",
                  {{{"name", "a"},
                    {"set", {{"observation.pixels", true}, {"observation.cameras", {"moon"}}}}}}}},
                {},
                2,
                {"arm 'a'", "moon", "front"}},
        Mistake{"AbsentModel",
                {{"arms", {{{"name", "a"}, {"set", {{"model", "/absent.xml"}}}}}}},
                {},
                2,
                {"arm 'a'", "/absent.xml"}},
        Mistake{"TooManyJobs", json::object(), {"--jobs", "1000"}, 2, {"--jobs 1000"}},
        Mistake{"SeedTwice", json::object(), {"--seeds", "1,1"}, 2, {"--seeds"}},
        Mistake{"ArmTwice", json::object(), {"--arms", "a,a"}, 2, {"--arms"}},
        Mistake{"UnknownArm", json::object(), {"--arms", "nope"}, 2, {"--arms", "nope", "a"}}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace shoal
