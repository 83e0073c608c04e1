// SPDX-License-Identifier: Apache-2.0
// Invalid messages do not count. Repeated ones: tests/simulation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/run_files.h"
#include "common/dds/bus.h"
#include "common/link/writer.h"
#include "tests/support/running_training.h"

namespace shoal {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using ::testing::HasSubstr;

double Value(const json& report, const char* name) { return report.value(name, 0.0); }

TEST(RepeatedMessages, AnEvaluationThatCannotBeIsSaidAndTheRunGoesOn) {
  const TrainingRun run;
  RunningTraining training(
      run, run.Command({{"env_steps", "10000000"}, {"actors", "1"}, {"eval.interval", "1000000"}}));
  ASSERT_TRUE(training.WaitForMoreSteps(200)) << training.Output();
  const RunConfig config = ReadRunConfig(run.path());
  dds::Bus bus(ReadClusterAddress(run.path()), config.config.transport, dds::Role::kEval);
  link::Writer<EvalMessage> publisher(bus);
  const SteadyTime start = Now();
  while (publisher.Matched() < 2 && Now() - start < seconds(20)) {  // coordinator and learner
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  // Well-formed, but of parameters that were never sent.
  EvalMessage forged;
  forged.env_steps = 1000;
  forged.version = {1, 5};
  forged.checkpoint = "step_000000005";
  const std::vector<json> episodes(8, json::object());
  forged.json = json{
      {"schema", "shoal-eval-1"},
      {"env_steps", 1000},
      {"weights_version", {{"session", 1}, {"update", 5}}},
      {"checkpoint", forged.checkpoint},
      {"aggregate", {{"return_mean", 0}, {"length_mean", 50}, {"success_rate", 1.0}}},
      {"episodes",
       episodes}}.dump();
  ASSERT_TRUE(publisher.Write(forged));
  EvalMessage message;
  message.env_steps = 2000;
  const std::string deep = std::string(1'000'000, '[') + std::string(1'000'000, ']');
  message.json = R"({"schema": "shoal-eval-1", "x": )" + deep + "}";
  ASSERT_TRUE(publisher.Write(message));
  const json refused = training.reports().WaitFor(
      "coordinator", [](const json& r) { return Value(r, "evaluations_refused") >= 2; });
  EXPECT_FALSE(refused.is_null()) << training.Output();
  EXPECT_TRUE(training.WaitForMoreSteps(200)) << training.Output();
  training.Interrupt();
  EXPECT_EQ(training.End(seconds(120)), kInterruptedExit) << training.Output();
  EXPECT_THAT(training.Output(),
              HasSubstr("evaluation refused (1 in all): evaluation at 2000 env"));
  for (const auto& entry : std::filesystem::directory_iterator(run.path() / "eval")) {
    const json evaluation = json::parse(ReadFile(entry.path()));
    EXPECT_NE(evaluation.at("checkpoint"), forged.checkpoint) << entry.path();
  }
}

}  // namespace
}  // namespace shoal
