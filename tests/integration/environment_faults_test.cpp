// SPDX-License-Identifier: Apache-2.0
// Python environments that are refused, fail, hang or print.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/integration/environments_fixture.h"

namespace shoal {
namespace {

using std::chrono::seconds;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST_F(Environments, WhatCannotBeTrainedIsRefusedInOneLineBeforeAnythingStarts) {
  const std::string folder = SourcePath("tests/integration/environments");
  const std::pair<std::string, std::string> refusals[] = {
      {"Nowhere-v0", "gymnasium knows no environment 'Nowhere-v0'"},
      {"nowhere.at_all:Point", "module 'nowhere.at_all' was not found"},
      {"faulty:DiscreteActions", "the action space is Discrete; expected a Box"},
      {"faulty:Unbounded", "expected finite bounds"},
      {"faulty:RaisesAtOnce", "step raised ValueError: the gripper is stuck"},
      {"faulty:DiscreteObservation", "the observation 'room' is Discrete; expected Box"},
      {"nowhere.py:Point", "file 'nowhere.py' does not exist"},
      {folder + "/point.py:Line", "has no class or function 'Line'"},
      {folder + "/point.py", "expected"}};
  for (const auto& [environment, expected] : refusals) {
    const ProgramResult done = Shoal(Words(environment), seconds(60));
    // An environment that fails is no mistake of the command.
    const int code = environment == "faulty:RaisesAtOnce" ? 1 : 2;
    EXPECT_EQ(ExitCode(done), code) << environment << ": " << done.out << done.err;
    EXPECT_THAT(done.err, HasSubstr(expected)) << environment;
    EXPECT_EQ(std::ranges::count(done.err, '\n'), 1) << done.err;
    EXPECT_FALSE(std::filesystem::exists(run_.path())) << environment;
  }
  const std::pair<std::string, std::string> keys[] = {{"env.python", "/nowhere/python"},
                                                      {"model", "robot.xml"},
                                                      {"env.kwargs", "[1]"},
                                                      {"env.kwargs", R"({"colour": 1})"},
                                                      {"observation.pixels", "true"}};
  for (const auto& [key, value] : keys) {
    const ProgramResult done = Shoal(Words("Point-v0", {{key, value}}), seconds(60));
    EXPECT_EQ(ExitCode(done), 2) << key << ": " << done.out << done.err;
    EXPECT_FALSE(std::filesystem::exists(run_.path())) << key;
  }
  const ProgramResult python =
      RunCommand({ProgramPath("shoal"), "train", "--env", "Point-v0", "--dry-run"}, seconds(60),
                 {{"PYTHONPATH", ""}, {"VIRTUAL_ENV", ""}});
  EXPECT_EQ(ExitCode(python), 2);
  EXPECT_THAT(python.err, HasSubstr("has no package shoal_rl"));
}

TEST_F(Environments, FaultsOfTheUsersCodeAreRestartedCountedAndNamed) {
  EXPECT_THAT(FailureOf("faulty:Raises"),
              HasSubstr("step raised ValueError: the gripper is stuck"));
  EXPECT_THAT(Log("actor-0"), AllOf(HasSubstr("Traceback"), HasSubstr("faulty.py")));
  EXPECT_THAT(FailureOf("faulty:Shape"), HasSubstr("'place' of step has the shape (2,); expected"));
  EXPECT_THAT(FailureOf("faulty:Type"), HasSubstr("has elements of type int64; expected float32"));
  EXPECT_THAT(FailureOf("faulty:Missing"), HasSubstr("of step has no 'aims.target'"));
}

TEST_F(Environments, ProcessesThatEndOfThemselvesAreRestartedAndCounted) {
  EXPECT_THAT(FailureOf("faulty:Leaves"), HasSubstr("exit code 7"));
  EXPECT_THAT(FailureOf("faulty:LeavesWell"), HasSubstr("exit code 0"));
  EXPECT_THAT(FailureOf("faulty:Segfaults"), HasSubstr("SIGSEGV"));
  EXPECT_THAT(Log("actor-0"), HasSubstr("_segfault")) << "the Python stack";
}

TEST_F(Environments, ACallThatDoesNotReturnEndsTheActorWithItsStack) {
  EXPECT_THAT(FailureOf("faulty:Hangs", {{"env.step_timeout", "0.5"}}),
              HasSubstr("step did not return within env.step_timeout = 0.5 s"));
  EXPECT_THAT(Log("actor-0"), HasSubstr("_hang"));
}

TEST_F(Environments, OneWhoseSpacesDifferBetweenProcessesIsRefused) {
  EXPECT_THAT(FailureOf("faulty:Changes", {}, /*plays=*/false),
              AllOf(HasSubstr("has changed since the run began"), HasSubstr("'action' was")));
}

TEST_F(Environments, NumbersThatAreNotFiniteEndEpisodesAndThenTheRun) {
  const ProgramResult done = Shoal(Words("faulty:NotFinite"));
  EXPECT_NE(ExitCode(done), 0);
  EXPECT_THAT(run_.Json("meta.json").value("error", ""), HasSubstr("'place' is nan"));
  ExpectBalanced(run_.Json("meta.json"));
}

TEST_F(Environments, OutputOfTheUsersCodeGoesToTheLog) {
  const ProgramResult done = Shoal(
      Words("faulty:Talks",
            {{"env_steps", "600"}, {"eval.interval", "1000000"}, {"eval.final_episodes", "0"}}));
  EXPECT_EQ(ExitCode(done), 0) << done.out << done.err;
  EXPECT_THAT(done.out, Not(HasSubstr("\nmoved\n")));
  EXPECT_THAT(Log("actor-0"), HasSubstr("moved"));
  ExpectBalanced(run_.Json("meta.json"));
}

}  // namespace
}  // namespace shoal
