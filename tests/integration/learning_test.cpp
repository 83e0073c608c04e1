// SPDX-License-Identifier: Apache-2.0
// State-based SAC on FetchReachDense through the real processes reaches 90 % success within five
// minutes.
#include <gtest/gtest.h>

#include "tests/support/training_run.h"

namespace shoal {
namespace {

TEST(Learning, FetchReachDenseFromStateReachesNinetyPercent) {
  const TemporaryFolder folder;
  const ProgramResult result =
      RunProgram({"shoal", "train", "--preset", "fetch-reach-state", "--run-name", "learn", "--set",
                  "run_dir=" + folder.path().string(), "--set", "stop.success=0.9"},
                 std::chrono::seconds(300));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  const auto meta = nlohmann::json::parse(ReadFile(folder.path() / "learn" / "meta.json"));
  ExpectBalanced(meta);
  const auto final_eval =
      nlohmann::json::parse(ReadFile(folder.path() / "learn" / "eval" / "final.json"));
  EXPECT_GE(final_eval.at("aggregate").at("success_rate").get<double>(), 0.9)
      << final_eval.at("aggregate").dump();
  EXPECT_EQ(final_eval.at("aggregate").at("episodes"), 50);
}

}  // namespace
}  // namespace shoal
