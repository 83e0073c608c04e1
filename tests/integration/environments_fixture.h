// SPDX-License-Identifier: Apache-2.0
// Actors with Python environments. A small replacement of the package gymnasium in environments/ is
// used, so that no download is needed.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/running_training.h"

namespace shoal {

class Environments : public testing::Test {
 protected:
  static RunningTraining::Environment Surroundings() {
    return {{"PYTHONPATH",
             ProgramPath("../package") + ":" + SourcePath("tests/integration/environments")},
            {"PYTHONDONTWRITEBYTECODE", "1"},
            {"VIRTUAL_ENV", ""}};
  }
  ProgramResult Shoal(std::vector<std::string> words,
                      std::chrono::seconds deadline = std::chrono::seconds(180)) const {
    words.insert(words.begin(), ProgramPath("shoal"));
    return RunCommand(std::move(words), deadline, Surroundings());
  }
  // Words of `shoal train` for an environment, for some thousand steps.
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
  // Trains an environment whose actors die repeatedly. Returns the run's error.
  std::string FailureOf(const std::string& environment, TrainingRun::Keys keys = {},
                        bool plays = true) const {
    keys["eval.interval"] = "1000000";
    const ProgramResult done = Shoal(Words(environment, keys, {"--overwrite"}));
    EXPECT_EQ(ExitCode(done), 1) << environment << ": " << done.out << done.err;
    const nlohmann::json meta = run_.Json("meta.json");
    EXPECT_EQ(meta.at("exit"), "failed") << environment;
    EXPECT_GE(meta.at("restarts"), 1) << environment;
    if (plays) ExpectBalanced(meta);
    return meta.value("error", "");
  }

  const TrainingRun run_{};
};

}  // namespace shoal
