// SPDX-License-Identifier: Apache-2.0
// Python environments: training, evaluation, films, and acting with a policy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/integration/environments_fixture.h"

namespace shoal {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using testing::AllOf;
using testing::HasSubstr;

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
  // Trains an environment for a short time, evaluates two episodes, and computes their actions
  // again from their observations, in Python with the checkpoint. Returns the output of
  // act_again.py.
  const auto act_again = [this](const std::string& environment, const TrainingRun::Keys& keys) {
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
  };
  EXPECT_EQ(act_again("point:Short", {}), "80 equal, 0 different\n");
  EXPECT_EQ(act_again("goals:Reach", {{"replay.hindsight", "future"}}), "40 equal, 0 different\n");
  EXPECT_EQ(act_again("point:Picture", {{"observation.height", "22"},
                                        {"observation.width", "26"},
                                        {"observation.grey", "true"},
                                        {"observation.stack", "3"}}),
            "60 equal, 0 different\n");
}

}  // namespace
}  // namespace shoal
