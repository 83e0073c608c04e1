// SPDX-License-Identifier: Apache-2.0
// Training runs whose results are compared with untrained policies. A learning test is meaningless
// if no-op or random actions also pass.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/program.h"
#include "tests/support/training_run.h"

namespace shoal {

// Results of two untrained policies: zero actions, and uniform random actions. The members are
// those of `aggregate` in eval/*.json.
struct Untrained {
  nlohmann::json noop, random;

  // The result `figure` of the better policy.
  double Most(const char* figure) const {
    return std::max(noop.at(figure).get<double>(), random.at(figure).get<double>());
  }
};

// Measures both policies on the same 50 episodes of a task.
inline Untrained PlayUntrained(const std::string& task) {
  const TemporaryFolder folder;
  const auto play = [&](const std::string& policy) {
    const std::filesystem::path file = folder.path() / (policy + ".json");
    const ProgramResult result = RunProgram({"shoal", "env", "random", task, "--policy", policy,
                                             "--episodes", "50", "--json", file.string()},
                                            std::chrono::seconds(120));
    EXPECT_EQ(ExitCode(result), 0) << result.out << result.err;
    return nlohmann::json::parse(ReadFile(file)).at("aggregate");
  };
  return {.noop = play("noop"), .random = play("random")};
}

// Result of a run.
struct LearningResult {
  nlohmann::json meta;
  nlohmann::json aggregate;  // of the final evaluation of the best checkpoint
};

// Trains with a preset; `keys` override the preset's keys. The run must end without an error, and
// the account of records must balance.
inline LearningResult Learn(const std::string& preset,
                            const std::map<std::string, std::string>& keys,
                            std::chrono::seconds deadline) {
  const TemporaryFolder folder;
  std::vector<std::string> command{
      "shoal",      "train",    "--preset", preset,
      "--run-name", "learning", "--set",    "run_dir=" + folder.path().string()};
  for (const auto& [key, value] : keys) {
    command.insert(command.end(), {"--set", key + "=" + value});
  }
  const ProgramResult result = RunProgram(command, deadline);
  EXPECT_EQ(ExitCode(result), 0) << result.out << result.err;
  const std::filesystem::path run = folder.path() / "learning";
  LearningResult learned;
  learned.meta = nlohmann::json::parse(ReadFile(run / "meta.json"));
  ExpectBalanced(learned.meta);
  learned.aggregate = nlohmann::json::parse(ReadFile(run / "eval/final.json")).at("aggregate");
  return learned;
}

// Trains with seed 1 and, unless the result is `enough`, again with seed 2. A single seed can fail
// although the algorithm learns; a broken algorithm fails with both seeds.
inline LearningResult LearnWithOneSeedOfTwo(
    const std::string& preset, std::map<std::string, std::string> keys,
    std::chrono::seconds deadline, const std::function<bool(const nlohmann::json&)>& enough) {
  keys["seed"] = "1";
  LearningResult learned = Learn(preset, keys, deadline);
  if (enough(learned.aggregate)) return learned;
  keys["seed"] = "2";
  return Learn(preset, keys, deadline);
}

// Trains on a task with goals, with the second seed unless the success rate of the final evaluation
// is at least `least`.
inline LearningResult LearnGoals(const std::string& preset,
                                 const std::map<std::string, std::string>& keys, double least) {
  return LearnWithOneSeedOfTwo(preset, keys, std::chrono::seconds(280),
                               [least](const nlohmann::json& aggregate) {
                                 return aggregate.at("success_rate").get<double>() >= least;
                               });
}

// Expects that the success rate of the final evaluation is at least `least`, and exceeds the rates
// of both untrained policies by far.
inline void ExpectSuccess(const LearningResult& learned, const std::string& task, double least) {
  constexpr double kMargin = 0.5;
  const double rate = learned.aggregate.at("success_rate").get<double>();
  EXPECT_GE(rate, least) << learned.aggregate.dump();
  EXPECT_GE(rate, PlayUntrained(task).Most("success_rate") + kMargin);
}

}  // namespace shoal
