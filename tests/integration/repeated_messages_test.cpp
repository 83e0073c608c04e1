// SPDX-License-Identifier: Apache-2.0
// Messages that the transport delivers again, and invalid messages, do not count.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>

#include "common/config/run_files.h"
#include "common/dds/bus.h"
#include "common/link/writer.h"
#include "tests/support/running_training.h"

namespace shoal {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using ::testing::HasSubstr;

constexpr seconds kBeyondTheLease{7};  // of the transport, 4 s

double Value(const json& report, const char* name) { return report.value(name, 0.0); }

int Lines(const std::string& text, const std::string& beginning) {
  int lines = 0;
  for (size_t at = text.find(beginning); at != text.npos; at = text.find(beginning, at + 1)) {
    ++lines;
  }
  return lines;
}

// The first evaluation is delivered twice: at stop.success=0 the run would end for it with one
// evaluation on its disk. The second one is far enough for the evaluation actor to be stopped
// before it.
TEST(RepeatedMessages, AnEvaluationDeliveredAgainAfterAPauseDoesNotCount) {
  const TrainingRun run;
  RunningTraining training(run, run.Command({{"env_steps", "10000000"},
                                             {"actors", "1"},
                                             {"eval.interval", "10000"},
                                             {"stop.success", "0"},
                                             {"stop.evaluations", "2"}}));
  ASSERT_FALSE(training.reports()
                   .WaitFor("eval", [](const json& r) { return Value(r, "evaluations") >= 1; })
                   .is_null())
      << training.Output();
  const pid_t eval = training.reports().Await("eval").at("pid").get<pid_t>();
  ASSERT_EQ(kill(eval, SIGSTOP), 0);
  std::this_thread::sleep_for(kBeyondTheLease);
  const int before = Lines(training.Output(), "evaluation at ");
  ASSERT_EQ(kill(eval, SIGCONT), 0);
  const json repeated = training.reports().WaitFor(
      "coordinator", [](const json& r) { return Value(r, "evaluations_repeated") >= 1; });
  EXPECT_FALSE(repeated.is_null()) << "this test did not meet what it is about";
  training.End(seconds(120));
  const auto files = std::filesystem::directory_iterator(run.path() / "eval");
  const auto stored = std::count_if(begin(files), end(files), [](const auto& entry) {
    return entry.path().filename().string().starts_with("steps_");
  });
  EXPECT_LE(before, 1);
  EXPECT_EQ(Lines(training.Output(), "evaluation at "), stored) << training.Output();
  EXPECT_EQ(run.Json("meta.json").at("exit"), "target");
  EXPECT_GE(stored, 2) << training.Output();
}

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
