// SPDX-License-Identifier: Apache-2.0
// The real programs, from `shoal train` to the summary.
#include "tests/support/training_run.h"

#include <gtest/gtest.h>

#include <numeric>
#include <sstream>

namespace shoal {
namespace {

TEST(TrainingRun, LeavesABalancedAccountAndEveryFile) {
  const TrainingRun run;
  const ProgramResult result = run.Train();
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;

  const auto meta = run.Json("meta.json");
  EXPECT_EQ(meta.at("schema"), "shoal-run-1");
  const auto config = run.Json("config.json");
  const int64_t actors = config.at("actors");
  const int64_t chunk = config.at("transport").at("chunk_records");
  EXPECT_GE(meta.at("env_steps").get<int64_t>(), 4000);
  EXPECT_LE(meta.at("env_steps").get<int64_t>(), 4000 + actors * chunk);
  EXPECT_GT(meta.at("updates").get<int64_t>(), 100);
  ExpectBalanced(meta);
  for (const char* nothing : {"lost_with_process", "rejected", "after_gap"}) {
    EXPECT_EQ(meta.at("accounting").at(nothing), 0) << nothing;
  }
  for (const char* file : {"config.json", "cluster.json", "metrics.jsonl", "accounting.json",
                           "checkpoints/best/policy.safetensors", "logs/learner-0.log"}) {
    EXPECT_TRUE(std::filesystem::exists(run.path() / file)) << file;
  }
  int evaluations = 0;
  for (const auto& entry : std::filesystem::directory_iterator(run.path() / "eval")) {
    const auto evaluation = nlohmann::json::parse(ReadFile(entry.path()));
    EXPECT_EQ(evaluation.at("schema"), "shoal-eval-1");
    EXPECT_EQ(evaluation.at("episodes").size(), 8u);
    ++evaluations;
  }
  EXPECT_GE(evaluations, 3) << "two while training and the final one";
}

TEST(TrainingRun, ItsLastLinesSayHowToLookAtIt) {
  const TrainingRun run;
  const ProgramResult result = run.Train({{"env_steps", "1500"}, {"eval.interval", "500"}});
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  const std::string path = run.path();
  EXPECT_NE(result.out.find("  curves: shoal plot " + path + "; page: shoal report " + path +
                            "; film: shoal film " + path + "\n"),
            std::string::npos)
      << result.out;
  const std::string page = run.parent() / "page.html";
  const ProgramResult report =
      RunProgram({"shoal", "report", path, "--output", page}, std::chrono::seconds(60));
  EXPECT_EQ(ExitCode(report), 0) << report.err;
  EXPECT_TRUE(std::filesystem::exists(page));
}

TEST(TrainingRun, EvaluationOfACheckpointRepeats) {
  const TrainingRun run;
  const ProgramResult result = run.Train({{"env_steps", "1500"}, {"eval.interval", "500"}});
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  const auto evaluate = [&](const std::string& seed) {
    const std::string file = (run.parent() / ("eval-" + seed + ".json")).string();
    const ProgramResult evaluation =
        RunProgram({"shoal", "eval", "--checkpoint", (run.path() / "checkpoints/best").string(),
                    "--episodes", "6", "--seed", seed, "--json", file},
                   std::chrono::seconds(60));
    EXPECT_EQ(ExitCode(evaluation), 0) << evaluation.err;
    return nlohmann::json::parse(ReadFile(file)).at("episodes");
  };
  const auto first = evaluate("7");
  EXPECT_EQ(first.size(), 6u);
  EXPECT_EQ(first, evaluate("7"));
  EXPECT_NE(first, evaluate("8"));
}

// Shares of what was drawn in an interval, of every report of the replay that has one.
std::vector<double> Shares(const TrainingRun& run, const std::string& name) {
  std::vector<double> shares;
  std::istringstream lines(ReadFile(run.path() / "metrics.jsonl"));
  for (std::string line; std::getline(lines, line);) {
    const auto report = nlohmann::json::parse(line);
    if (report.at("role") == "replay" && report.contains(name)) shares.push_back(report.at(name));
  }
  return shares;
}

TEST(TrainingRun, HindsightLearnsFromEpisodesThatEndOnSuccess) {
  const TrainingRun run;
  const ProgramResult result = run.Train({{"distance_threshold", "0.15"},
                                          {"end_on_success", "true"},
                                          {"eval.interval", "1000"},
                                          {"replay.n_step", "3"}},
                                         {"--preset", "fetch-reach-her"});
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  ExpectBalanced(run.Json("meta.json"));
  const auto final = run.Json("eval/final.json");
  EXPECT_EQ(final.at("end_on_success"), true);
  int succeeded = 0;
  for (const auto& episode : final.at("episodes")) {
    const bool success = episode.at("success");
    const int length = episode.at("length");
    EXPECT_TRUE(success || length == 50) << length;
    succeeded += success && length < 50 ? 1 : 0;
  }
  EXPECT_GT(succeeded, 0);
  const std::vector<double> relabelled = Shares(run, "relabelled_share");
  ASSERT_FALSE(relabelled.empty());
  const double sum = std::accumulate(relabelled.begin(), relabelled.end(), 0.0);
  EXPECT_NEAR(sum / static_cast<double>(relabelled.size()), 0.8, 0.05) << "4 to 1";
  const std::vector<double> zero_rewards = Shares(run, "zero_reward_share");
  EXPECT_EQ(zero_rewards.size(), relabelled.size());
  EXPECT_GT(zero_rewards.back(), 0.05);
  EXPECT_LT(zero_rewards.back(), 0.95);
}

TEST(TrainingRun, AnExistingRunIsNotOverwritten) {
  const TrainingRun run;
  MakeFolders(run.path());
  WriteFileAtomically(run.path() / "precious", "x");
  const ProgramResult result = run.Train();
  EXPECT_NE(ExitCode(result), 0);
  EXPECT_NE(result.err.find(run.path().string()), std::string::npos) << result.err;
  EXPECT_EQ(ReadFile(run.path() / "precious"), "x");
  EXPECT_FALSE(std::filesystem::exists(run.path() / "config.json"));
}

}  // namespace
}  // namespace shoal
