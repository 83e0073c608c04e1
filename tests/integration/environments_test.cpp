// SPDX-License-Identifier: Apache-2.0
// Environments of Python as actors: trained, judged, refused, restarted. The package gymnasium is
// the tests' own (environments/), so that no network is needed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/support/running_training.h"

namespace shoal {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Environments : public testing::Test {
 protected:
  static RunningTraining::Environment Surroundings() {
    return {{"PYTHONPATH",
             ProgramPath("../package") + ":" + SourcePath("tests/integration/environments")},
            {"PYTHONDONTWRITEBYTECODE", "1"},
            {"VIRTUAL_ENV", ""}};
  }
  ProgramResult Shoal(std::vector<std::string> words, seconds deadline = seconds(180)) const {
    words.insert(words.begin(), ProgramPath("shoal"));
    return RunCommand(std::move(words), deadline, Surroundings());
  }
  // Trains `environment` a little, evaluates two episodes of it, and acts on their observations
  // again, by the checkpoint and Python: what act_again.py says.
  std::string ActAgain(const std::string& environment, const TrainingRun::Keys& keys) const {
    TrainingRun::Keys all{{"env.kwargs", json{{"of", environment}}.dump()},
                          {"env_steps", "400"},
                          {"replay.min_size", "100"},
                          {"eval.envs", "1"},
                          {"eval.interval", "1000000"},
                          {"learner.precision", "f32"}};
    for (const auto& [key, value] : keys) all[key] = value;
    const ProgramResult done = Shoal(Words("recorded:Recorded", all, {"--overwrite"}));
    EXPECT_EQ(ExitCode(done), 0) << environment << ": " << done.out << done.err;
    RunningTraining::Environment recording = Surroundings();
    recording.emplace_back("SHOAL_TEST_RECORD", run_.path().string());
    const ProgramResult judged = RunCommand(
        {ProgramPath("shoal"), "eval", run_.path(), "--episodes", "2"}, seconds(60), recording);
    EXPECT_EQ(ExitCode(judged), 0) << environment << ": " << judged.out << judged.err;
    const ProgramResult again =
        RunCommand({SHOAL_TEST_PYTHON, SourcePath("tests/integration/environments/act_again.py"),
                    run_.path() / "checkpoints" / "best", run_.path() / "moments"},
                   seconds(60), Surroundings());
    EXPECT_EQ(ExitCode(again), 0) << environment << ": " << again.out << again.err;
    return again.out;
  }
  // `shoal train` of an environment, for some thousand steps.
  std::vector<std::string> Words(const std::string& environment, TrainingRun::Keys keys = {},
                                 const std::vector<std::string>& flags = {}) const {
    TrainingRun::Keys all{{"env_steps", "2000"},
                          {"actors", "1"},
                          {"eval.episodes", "4"},
                          {"env.python", SHOAL_TEST_PYTHON},
                          {"eval.final_episodes", "4"},
                          {"eval.interval", "1000"},
                          {"learner.batch", "32"},
                          {"network.hidden", "[32]"},
                          {"replay.capacity", "5000"},
                          {"replay.min_size", "200"},
                          {"replay.samples_per_insert", "8"},
                          {"run_dir", run_.parent().string()},
                          {"run_name", run_.path().filename().string()},
                          {"stop.success", "2"}};
    for (const auto& [key, value] : keys) all[key] = value;
    std::vector<std::string> words{"train", "--env", environment};
    for (const auto& [key, value] : all) {
      words.insert(words.end(), {"--set", key + "=" + value});
    }
    words.insert(words.end(), flags.begin(), flags.end());
    return words;
  }
  std::string Log(const std::string& process) const {
    return ReadFile(run_.path() / "logs" / (process + ".log"));
  }
  // Trains an environment whose actors die again and again: the run's error.
  std::string FailureOf(const std::string& environment, TrainingRun::Keys keys = {},
                        bool plays = true) const {
    keys["eval.interval"] = "1000000";
    const ProgramResult done = Shoal(Words(environment, keys, {"--overwrite"}));
    EXPECT_EQ(ExitCode(done), 1) << environment << ": " << done.out << done.err;
    const json meta = run_.Json("meta.json");
    EXPECT_EQ(meta.at("exit"), "failed") << environment;
    EXPECT_GE(meta.at("restarts"), 1) << environment;
    if (plays) ExpectBalanced(meta);
    return meta.value("error", "");
  }

  const TrainingRun run_{};
};

TEST_F(Environments, OneByNameIsTrainedJudgedAndGoesOn) {
  const ProgramResult done = Shoal(Words("Point-v0"));
  ASSERT_EQ(ExitCode(done), 0) << done.out << done.err << Log("actor-0");
  EXPECT_THAT(done.out, AllOf(HasSubstr("environment Point-v0, run by "),
                              HasSubstr("preset state, because it observes no image")));
  const json meta = run_.Json("meta.json");
  EXPECT_GE(meta.at("env_steps"), 2000);
  ExpectBalanced(meta);
  const json spec = run_.Json("config.json").at("spec");
  EXPECT_EQ(spec.at("task"), "Point-v0");
  EXPECT_EQ(spec.at("blocks")[1].at("name"), "aims.target");
  const json judged = run_.Json("eval/final.json");
  EXPECT_EQ(judged.at("aggregate").at("length_mean"), 40) << "its time limit";
  EXPECT_TRUE(judged.at("aggregate").contains("success_rate")) << "info has is_success";

  const ProgramResult again = Shoal({"eval", run_.path(), "--episodes", "3", "--seed", "5"});
  EXPECT_EQ(ExitCode(again), 0) << again.out << again.err;

  const ProgramResult resumed =
      Shoal({"train", "--resume", run_.path(), "--set", "env_steps=2400"});
  EXPECT_EQ(ExitCode(resumed), 0) << resumed.out << resumed.err;
  ExpectBalanced(run_.Json("meta.json"));
}

// The commands of docs/own_environment.md.
TEST_F(Environments, TheWorkedExampleIsTrainedAndFilmed) {
  const ProgramResult done =
      Shoal(Words(SourcePath("docs/examples/own_environment/catch_light.py") + ":CatchLight"));
  ASSERT_EQ(ExitCode(done), 0) << done.out << done.err;
  ExpectBalanced(run_.Json("meta.json"));
  EXPECT_EQ(run_.Json("config.json").at("task"), "catch_light.CatchLight");
  EXPECT_EQ(run_.Json("eval/final.json").at("aggregate").at("length_mean"), 100);
  const ProgramResult film = Shoal({"film", run_.path(), "--episodes", "1"});
  EXPECT_EQ(ExitCode(film), 0) << film.out << film.err;
  EXPECT_GT(std::filesystem::file_size(run_.path() / "videos" / "best.mp4"), 1000u);
}

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

// The environment may bring another version of MuJoCo.
TEST_F(Environments, TheActorLoadsNoEngineOfShoals) {
  const ProgramResult done = Shoal(CheckWords("engines:Alone"));
  EXPECT_EQ(ExitCode(done), 0) << done.out << done.err;
}

TEST_F(Environments, RewardsOfAGoalEnvironmentAreComputedForOtherGoals) {
  const TrainingRun::Keys keys{{"replay.hindsight", "future"}, {"eval.interval", "1000000"}};
  const ProgramResult done = Shoal(Words("goals:Reach", keys));
  ASSERT_EQ(ExitCode(done), 0) << done.out << done.err;
  ExpectBalanced(run_.Json("meta.json"));
  EXPECT_EQ(run_.Json("config.json").at("observation").at("goal_mode"), "both");
  const ProgramResult refused = Shoal(Words("goals:Box", keys, {"--overwrite"}));
  EXPECT_EQ(ExitCode(refused), 2) << refused.out << refused.err;
  EXPECT_THAT(refused.err, HasSubstr("no goals that Shoal knows: its reward is no threshold"));
}

// The user's step and Shoal's share of it: point.Slow takes 2 ms for each.
TEST_F(Environments, TimeOfTheUsersCodeIsReportedApart) {
  const ProgramResult done = Shoal(
      Words("point:Slow",
            {{"env_steps", "600"}, {"eval.interval", "1000000"}, {"eval.final_episodes", "0"}}));
  ASSERT_EQ(ExitCode(done), 0) << done.out << done.err;
  EXPECT_THAT(done.out, AllOf(HasSubstr(" user code "), HasSubstr(" conversion ")));
  json last;
  std::istringstream lines(ReadFile(run_.path() / "metrics.jsonl"));
  for (std::string line; std::getline(lines, line);) {
    const json report = json::parse(line);
    if (report.at("role") == "actor") last = report;
  }
  const double steps = last.at("env_steps");
  ASSERT_GE(steps, 600);
  EXPECT_GE(last.at("seconds_user_code"), 0.002 * steps);
  EXPECT_GE(last.at("seconds_conversion"), 0.002 * steps);
  EXPECT_FALSE(last.contains("seconds_physics"));
  const json shares = run_.Json("bottleneck.json").at("roles").at(0).at("shares");
  EXPECT_GT(shares.at("user_code"), 0.005);
  EXPECT_GT(shares.at("conversion"), 0.005);
  EXPECT_FALSE(shares.contains("physics"));
}

TEST_F(Environments, PicturesAreTrainedFrom) {
  const ProgramResult done =
      Shoal(Words("point:Picture", {{"env.kwargs", R"({"channels_first": true})"},
                                    {"env_steps", "400"},
                                    {"replay.min_size", "100"},
                                    {"observation.height", "24"},
                                    {"observation.width", "24"},
                                    {"eval.interval", "1000000"},
                                    {"eval.final_episodes", "0"}}));
  ASSERT_EQ(ExitCode(done), 0) << done.out << done.err;
  EXPECT_THAT(done.out, HasSubstr("preset pixels, because it observes observation"));
  const json spec = run_.Json("config.json").at("spec");
  EXPECT_EQ(spec.at("cameras"), json::array({"observation"}));
  EXPECT_EQ(spec.at("channels"), 3);
  EXPECT_EQ(spec.at("height"), 24);
  ExpectBalanced(run_.Json("meta.json"));
}

// The runs of an experiment get what `shoal train` would choose from the spaces: here, that the
// policy sees both goals.
TEST_F(Environments, AnExperimentTrainsOnOneToo) {
  json set{{"env.id", "goals:Reach"}, {"env.python", SHOAL_TEST_PYTHON},
           {"env_steps", 400},        {"actors", 1},
           {"eval.episodes", 2},      {"eval.interval", 1000000},
           {"learner.batch", 32},     {"learner.threads", 1},
           {"network.hidden", {32}},  {"replay.hindsight", "future"},
           {"replay.capacity", 5000}, {"replay.min_size", 100}};
  json definition{{"schema", "shoal-experiment-definition-1"},
                  {"base", "state"},
                  {"set", set},
                  {"arms", {{{"name", "plain"}, {"set", json::object()}}}},
                  {"seeds", {1}},
                  {"final_episodes", 2}};
  const std::filesystem::path file = run_.parent() / "reach.json", out = run_.parent() / "reach";
  const auto run = [&] {
    std::ofstream(file) << definition;
    return Shoal({"experiment", "run", file, "--out", out});
  };
  const ProgramResult done = run();
  ASSERT_EQ(ExitCode(done), 0) << done.out << done.err;
  EXPECT_THAT(done.err, HasSubstr("no baselines of Reach: environments of Python have none"));
  const std::filesystem::path trained = out / "runs" / "plain-s1";
  const json config = json::parse(ReadFile(trained / "config.json"));
  EXPECT_EQ(config.at("observation").at("goal_mode"), "both");
  ExpectBalanced(json::parse(ReadFile(trained / "meta.json")));

  std::filesystem::remove_all(out);
  definition["arms"][0]["set"] = {{"env.id", "goals:Dense"}};
  const ProgramResult other = run();
  EXPECT_EQ(ExitCode(other), 2) << other.out;
  EXPECT_THAT(other.err, HasSubstr("its arms have one environment"));
}

// A policy outside of its run acts as the evaluation did: dicts, pictures, stacks and the bounds of
// actions are mapped alike.
TEST_F(Environments, APolicyActsInPythonAsItWasEvaluated) {
  EXPECT_EQ(ActAgain("point:Short", {}), "80 equal, 0 different\n");
  EXPECT_EQ(ActAgain("goals:Reach", {{"replay.hindsight", "future"}}), "40 equal, 0 different\n");
  EXPECT_EQ(ActAgain("point:Picture", {{"observation.height", "22"},
                                       {"observation.width", "26"},
                                       {"observation.grey", "true"},
                                       {"observation.stack", "3"}}),
            "60 equal, 0 different\n");
}

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
