// SPDX-License-Identifier: Apache-2.0
// Descriptions of Python environments, and the refusal to resume a run with a changed environment.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/integration/environments_fixture.h"

namespace shoal {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

// The environment is run by the Python for which the package is built.
std::vector<std::string> CheckWords(const std::string& environment) {
  return {"env", "check", environment, "--set", std::string("env.python=") + SHOAL_TEST_PYTHON};
}

TEST_F(Environments, CheckSaysWhatIsObservedAndWhetherItRepeats) {
  const ProgramResult done = Shoal(CheckWords("Point-v0"));
  EXPECT_EQ(ExitCode(done), 0) << done.err;
  EXPECT_THAT(done.out, AllOf(HasSubstr("aims.target: 1 in [-1, 1], block of 1 numbers"),
                              HasSubstr("action: 1 numbers in [-2, 2], mapped to [-1, 1]"),
                              HasSubstr("episodes of at most 40 steps; steps report success"),
                              HasSubstr("OK    equal seeds and actions gave equal episodes")));
  const ProgramResult drifts = Shoal(CheckWords("faulty:Drifts"));
  EXPECT_EQ(ExitCode(drifts), 0) << drifts.err;
  EXPECT_THAT(drifts.out, HasSubstr("WARN  equal seeds and actions gave other observations or "
                                    "rewards from step 0 on"));
  const ProgramResult goal = Shoal(CheckWords("goals:Reach"));
  EXPECT_THAT(goal.out,
              HasSubstr("OK    hindsight: the rewards are sparse, threshold 0.05; verified"))
      << goal.err;
  const ProgramResult dense = Shoal(CheckWords("goals:Dense"));
  EXPECT_THAT(dense.out, HasSubstr("OK    hindsight: the rewards are dense, minus the distance"))
      << dense.err;
  const ProgramResult box = Shoal(CheckWords("goals:Box"));
  EXPECT_THAT(box.out, HasSubstr("WARN  no hindsight: its reward is no threshold")) << box.err;
}

// The environment may bring another version of MuJoCo.
TEST_F(Environments, TheActorLoadsNoEngineOfShoals) {
  const ProgramResult done = Shoal(CheckWords("engines:Alone"));
  EXPECT_EQ(ExitCode(done), 0) << done.out << done.err;
}

TEST_F(Environments, DescribeShowsWhatBecomesOfEachArray) {
  const std::string python = std::string("env.python=") + SHOAL_TEST_PYTHON;
  const ProgramResult state = Shoal({"env", "describe", "Point-v0", "--set", python});
  EXPECT_EQ(ExitCode(state), 0) << state.err;
  EXPECT_THAT(
      state.out,
      AllOf(HasSubstr("place: float32 (1) -> block 'place' of 1 numbers in [-10, 10], which the "
                      "policy sees"),
            HasSubstr("aims.target: float64 (1) -> block 'aims.target'"),
            HasSubstr("number 0: -2 + (a + 1) / 2 * 4, in [-2, 2]"),
            HasSubstr("episodes: at most 40 steps; steps report success"),
            HasSubstr("rewards: the environment's own\n"), HasSubstr("numbers   place (1), aims")));

  const ProgramResult picture =
      Shoal({"env", "describe", "point:Picture", "--json", "-", "--set", python, "--set",
             "observation.height=24", "--set", "observation.grey=true"});
  EXPECT_EQ(ExitCode(picture), 0) << picture.err;
  EXPECT_THAT(picture.err, HasSubstr("frame of camera 'observation', 1 x 24 x 84, resized by "
                                     "averaging over areas, made grey"));
  const json mapping = json::parse(picture.out);
  EXPECT_EQ(mapping.at("preset"), "pixels");
  EXPECT_EQ(mapping.at("observation")[0].at("frame"), json::array({1, 24, 84}));

  const ProgramResult goal =
      Shoal({"env", "describe", "goals:Reach", "--preset", "fetch-reach-her", "--set", python});
  EXPECT_EQ(ExitCode(goal), 0) << goal.err;
  EXPECT_THAT(goal.out, AllOf(HasSubstr("beyond a distance of 0.05, else 0, for other goals"),
                              HasSubstr("achieved_goal' of 2 numbers in [-inf, inf], recorded")));
  const ProgramResult refused =
      Shoal({"env", "describe", "faulty:DiscreteActions", "--set", python});
  EXPECT_EQ(ExitCode(refused), 2);
  EXPECT_THAT(refused.err, HasSubstr("the action space is Discrete"));
}

// The specification's hash covers the environment's spaces.
TEST_F(Environments, OneThatHasChangedIsRefusedWhenTheRunGoesOn) {
  const std::filesystem::path file = run_.parent() / "mine.py";
  const auto write = [&](const std::string& high) {
    std::ofstream(file) << "import gymnasium, point\n"
                           "class Mine(point.Point):\n"
                           "    def __init__(self):\n"
                           "        super().__init__(limit=40)\n"
                           "        self.action_space = gymnasium.spaces.Box(-2, "
                        << high << ", (1,))\n";
  };
  write("2");
  const TrainingRun::Keys keys{{"eval.interval", "1000000"}, {"eval.final_episodes", "0"}};
  const ProgramResult done = Shoal(Words(file.string() + ":Mine", keys));
  ASSERT_EQ(ExitCode(done), 0) << done.out << done.err;
  const ProgramResult described = Shoal({"env", "describe", "--run", run_.path()});
  EXPECT_THAT(described.out, HasSubstr("number 0: -2 + (a + 1) / 2 * 4, in [-2, 2]"))
      << described.err;

  write("3");
  const std::vector<std::string> words{"train", "--resume", run_.path(), "--set", "env_steps=2400"};
  const ProgramResult refused = Shoal(words);
  EXPECT_EQ(ExitCode(refused), 1) << refused.out;
  EXPECT_THAT(refused.err, AllOf(HasSubstr("has changed since the run began: 'action' was"),
                                 HasSubstr("\"high\":3.0")));
  EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << refused.err;

  write("2");
  const ProgramResult resumed = Shoal(words);
  EXPECT_EQ(ExitCode(resumed), 0) << resumed.out << resumed.err;
}

// The replay computes rewards by the threshold that was found when the run began.
TEST_F(Environments, AnotherThresholdIsRefusedWhenTheRunGoesOn) {
  const std::filesystem::path file = run_.parent() / "mine.py";
  const auto write = [&](const std::string& reward) {
    std::ofstream(file) << "import goals, numpy as np\n"
                           "class Mine(goals.Reach):\n"
                           "    def compute_reward(self, achieved_goal, desired_goal, info):\n"
                           "        apart = np.abs(achieved_goal - desired_goal)\n"
                           "        return -float("
                        << reward << ")\n";
  };
  write("np.linalg.norm(apart) > 0.05");
  const TrainingRun::Keys keys{{"replay.hindsight", "future"},
                               {"env_steps", "400"},
                               {"eval.interval", "1000000"},
                               {"eval.final_episodes", "0"}};
  const ProgramResult done = Shoal(Words(file.string() + ":Mine", keys));
  ASSERT_EQ(ExitCode(done), 0) << done.out << done.err;
  const std::vector<std::string> words{"train", "--resume", run_.path(), "--set", "env_steps=500"};
  const std::pair<const char*, const char*> changes[] = {
      {"np.linalg.norm(apart) > 0.06", "\"threshold\":0.05} and is {"},
      {"apart.max() > 0.05", "its reward is no threshold"}};
  for (const auto& [reward, expected] : changes) {
    write(reward);
    const ProgramResult refused = Shoal(words);
    EXPECT_NE(ExitCode(refused), 0) << refused.out;
    EXPECT_THAT(refused.err, HasSubstr(expected));
    EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << refused.err;
  }
  write("np.linalg.norm(apart) > 0.05");
  const ProgramResult resumed = Shoal(words);
  EXPECT_EQ(ExitCode(resumed), 0) << resumed.out << resumed.err;
}

}  // namespace
}  // namespace shoal
