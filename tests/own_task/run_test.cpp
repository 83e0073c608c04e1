// SPDX-License-Identifier: Apache-2.0
// The programs with the worked example of docs/own_task.md, as its page has it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/paths.h"
#include "tests/support/program.h"

namespace shoal {
namespace {

std::string Library() { return ProgramPath("point_reach.so"); }

TEST(OwnTaskRun, ALibraryThatDoesNotLoadEndsARunBeforeItBegins) {
  const TemporaryFolder folder;
  const ProgramResult result =
      RunProgram({"shoal", "train", "--set", "task_library=/nowhere/tasks.so", "--set",
                  "run_dir=" + folder.path().string()},
                 std::chrono::seconds(60));
  EXPECT_EQ(ExitCode(result), 2);
  EXPECT_NE(result.err.find("task_library: cannot load /nowhere/tasks.so"), std::string::npos)
      << result.err;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(OwnTaskRun, TheCommandsOfItsPageWork) {
  const TemporaryFolder folder;
  const auto run = [](std::vector<std::string> command) {
    command.insert(command.begin(), "shoal");
    command.insert(command.end(), {"--task-library", Library()});
    const ProgramResult result = RunProgram(command, std::chrono::seconds(60));
    EXPECT_EQ(ExitCode(result), 0) << result.out << result.err;
    return result.out;
  };
  EXPECT_NE(run({"env", "list"}).find("PointReachDense"), std::string::npos);
  EXPECT_NE(run({"env", "describe", "PointReachDense"}).find("push_x"), std::string::npos);
  EXPECT_NE(run({"env", "reward-check", "PointReachDense"}).find("passed"), std::string::npos);
  run({"env", "render", "PointReachDense", "--camera", "top", "--png",
       (folder.path() / "top.png").string()});
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "top.png"));
}

// Trains PointReachDense in FOLDER/point by JSON alone, with a camera of its own and a threshold of
// 0.1 m; `more` has further members.
ProgramResult TrainPoint(const std::filesystem::path& folder, const std::string& observation,
                         const std::string& more, std::chrono::seconds deadline) {
  const std::filesystem::path json = folder / "point.json";
  WriteFileAtomically(json, R"({
    "task_library": ")" + Library() +
                                R"(",
    "task": "PointReachDense",
    "distance_threshold": 0.1,
    "actors": 1,
    "observation": {
      "cameras": ["above"],
      "custom_cameras": {
        "above": {"lookat": [0, 0, 0], "distance": 1.4, "azimuth": 90, "elevation": -89}
      },
      "height": 32, "width": 32, )" +
                                observation + "}, " + more + "}");
  return RunProgram({"shoal", "train", "--config", json.string(), "--run-name", "point", "--set",
                     "run_dir=" + folder.string()},
                    deadline);
}

TEST(OwnTaskRun, TrainsFromItsOwnCameraWithAThresholdFromJson) {
  const TemporaryFolder folder;
  const ProgramResult result = TrainPoint(folder.path(), R"("proprioception": true)", R"(
    "env_steps": 600,
    "network": {"filters": [8, 8], "strides": [2, 1], "hidden": [32, 32]},
    "replay": {"min_size": 100, "capacity": 2000},
    "learner": {"batch": 16, "threads": 1},
    "eval": {"episodes": 4, "final_episodes": 4, "interval": 300},
    "stop": {"success": 2})",
                                          std::chrono::seconds(200));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  const auto run = folder.path() / "point";
  const auto meta = nlohmann::json::parse(ReadFile(run / "meta.json"));
  EXPECT_EQ(meta.at("task"), "PointReachDense");
  EXPECT_GT(meta.at("updates").get<int64_t>(), 10);
  const auto config = nlohmann::json::parse(ReadFile(run / "config.json"));
  EXPECT_EQ(config.at("spec").at("cameras"), std::vector<std::string>{"above"});
  // An episode is judged by the threshold of the configuration.
  for (const auto& entry : std::filesystem::directory_iterator(run / "eval")) {
    const auto evaluation = nlohmann::json::parse(ReadFile(entry.path()));
    for (const auto& episode : evaluation.at("episodes")) {
      EXPECT_EQ(episode.at("success").get<bool>(),
                episode.at("final_distance").get<double>() < 0.1);
    }
  }
}

// Share of 200 episodes that end within the threshold of TrainPoint with an untrained policy.
double UntrainedSuccess(const std::string& policy) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "untrained.json";
  const ProgramResult result =
      RunProgram({"shoal", "env", "random", "PointReachDense", "--task-library", Library(),
                  "--policy", policy, "--episodes", "200", "--json", file.string()},
                 std::chrono::seconds(60));
  EXPECT_EQ(ExitCode(result), 0) << result.out << result.err;
  const auto json = nlohmann::json::parse(ReadFile(file));
  for (const auto& point : json.at("success_by_threshold")) {
    if (point.at("threshold") == 0.1) return point.at("success_rate");
  }
  ADD_FAILURE() << result.out;
  return 1;
}

// Learning from pixels through all parts: rendering, records, stacks, shifts, encoder, weights.
// Only the picture shows the goal; a policy that does not see the goal ends within 0.1 m of one
// goal in twelve.
TEST(OwnTaskRun, LearnsFromPixelsAlone) {
  const TemporaryFolder folder;
  const ProgramResult result =
      TrainPoint(folder.path(), R"("goal_mode": "none", "proprioception": false, "stack": 2)", R"(
    "env_steps": 60000,
    "network": {"filters": [16, 16], "strides": [2, 1], "hidden": [64, 64]},
    "replay": {"min_size": 500, "capacity": 60000, "samples_per_insert": 32, "shift_pad": 2},
    "learner": {"batch": 64, "threads": 1, "learning_rate": 1e-3, "discount": 0.8},
    "eval": {"episodes": 20, "final_episodes": 0, "interval": 2500},
    "stop": {"success": 0.5, "evaluations": 2})",
                 std::chrono::seconds(180));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  const auto meta = nlohmann::json::parse(ReadFile(folder.path() / "point" / "meta.json"));
  EXPECT_EQ(meta.at("exit"), "target") << result.out;
  for (const char* policy : {"noop", "random"}) EXPECT_LT(UntrainedSuccess(policy), 0.25) << policy;
}

}  // namespace
}  // namespace shoal
