// SPDX-License-Identifier: Apache-2.0
// PPO from state, through the real processes, until nine of ten episodes succeed.
#include <gtest/gtest.h>

#include "tests/support/training_run.h"

namespace shoal {
namespace {

// At about 57,000 env steps, half a minute on two busy cores.
TEST(OnPolicyLearning, FetchReachReachesNinetyPercentFromState) {
  const TemporaryFolder folder;
  const ProgramResult result =
      RunProgram({"shoal", "train", "--preset", "fetch-reach-ppo", "--run-name", "learning",
                  "--set", "run_dir=" + folder.path().string(), "--set", "env_steps=250000",
                  "--set", "stop.evaluations=1", "--set", "stop.success=0.9"},
                 std::chrono::seconds(500));
  EXPECT_EQ(ExitCode(result), 0) << result.out << result.err;
  const auto meta = nlohmann::json::parse(ReadFile(folder.path() / "learning" / "meta.json"));
  ExpectBalanced(meta);
  EXPECT_EQ(meta.at("exit"), "target");
  EXPECT_GE(meta.at("final_success_rate").get<double>(), 0.85) << meta.dump();
}

}  // namespace
}  // namespace shoal
