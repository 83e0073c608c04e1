// SPDX-License-Identifier: Apache-2.0
// State-based SAC on tasks without goals, through the real processes.
#include <gtest/gtest.h>

#include "tests/support/training_run.h"

namespace shoal {
namespace {

// aggregate of the final evaluation after so many env steps with the preset.
nlohmann::json TrainWith(const std::string& preset, int env_steps) {
  const TemporaryFolder folder;
  const ProgramResult result = RunProgram(
      {"shoal", "train", "--preset", preset, "--run-name", "learning", "--set",
       "run_dir=" + folder.path().string(), "--set", "env_steps=" + std::to_string(env_steps)},
      std::chrono::seconds(280));
  EXPECT_EQ(ExitCode(result), 0) << result.out << result.err;
  const auto run = folder.path() / "learning";
  const auto meta = nlohmann::json::parse(ReadFile(run / "meta.json"));
  ExpectBalanced(meta);
  EXPECT_EQ(meta.at("exit"), "budget");
  EXPECT_TRUE(meta.at("first_success").is_null());
  EXPECT_TRUE(meta.at("final_success_rate").is_null());

  const auto final_eval = nlohmann::json::parse(ReadFile(run / "eval" / "final.json"));
  const auto& aggregate = final_eval.at("aggregate");
  EXPECT_TRUE(aggregate.at("success_rate").is_null());
  EXPECT_TRUE(aggregate.at("final_distance_mean").is_null());
  return aggregate;
}

// From the 128 points that random actions earn to at least 800 of 1000.
TEST(ControlLearning, CartpoleSwingsUpFromState) {
  const nlohmann::json aggregate = TrainWith("cartpole-swingup-state", 9000);
  EXPECT_EQ(aggregate.at("length_mean"), 125);
  EXPECT_GE(aggregate.at("return_mean").get<double>(), 800) << aggregate.dump();
}

// From the 20 points that random actions earn to at least 150.
TEST(ControlLearning, HopperStaysUpFromState) {
  const nlohmann::json aggregate = TrainWith("hopper-state", 12000);
  EXPECT_GE(aggregate.at("return_mean").get<double>(), 150) << aggregate.dump();
}

}  // namespace
}  // namespace shoal
