// State-based SAC on cartpole_swingup, a task without goals, through the real processes: from the few
// points that random actions earn to at least 300 of 1000.
#include <gtest/gtest.h>

#include "tests/support/training_run.h"

namespace shoal {
namespace {

TEST(ControlLearning, CartpoleSwingsUpFromState) {
  const TemporaryFolder folder;
  const ProgramResult result =
      RunProgram({"shoal", "train", "--preset", "cartpole-swingup-state", "--run-name", "swing",
                  "--set", "run_dir=" + folder.path().string()},
                 std::chrono::seconds(280));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  const auto run = folder.path() / "swing";
  const auto meta = nlohmann::json::parse(ReadFile(run / "meta.json"));
  ExpectBalanced(meta);
  EXPECT_EQ(meta.at("exit"), "budget");
  EXPECT_TRUE(meta.at("first_success").is_null());
  EXPECT_TRUE(meta.at("final_success_rate").is_null());

  const auto final_eval = nlohmann::json::parse(ReadFile(run / "eval" / "final.json"));
  const auto& aggregate = final_eval.at("aggregate");
  EXPECT_TRUE(aggregate.at("success_rate").is_null());
  EXPECT_TRUE(aggregate.at("final_distance_mean").is_null());
  EXPECT_EQ(aggregate.at("length_mean"), 125);
  EXPECT_GE(aggregate.at("return_mean").get<double>(), 300) << aggregate.dump();
}

}  // namespace
}  // namespace shoal
