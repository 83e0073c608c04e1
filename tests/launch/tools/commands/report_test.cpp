// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "launch/tools/commands/commands.h"
#include "tests/launch/tools/experiment/planted_run.h"
#include "tests/support/error_message.h"

namespace shoal::launch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// Runs `shoal ARGUMENTS` for a command that `add` adds; returns what it prints.
std::string Printed(void (*add)(CLI::App&, Action*), std::vector<std::string> arguments) {
  CLI::App app;
  Action chosen;
  add(app, &chosen);
  std::ranges::reverse(arguments);  // as CLI11 takes them
  app.parse(arguments);
  testing::internal::CaptureStdout();
  EXPECT_EQ(chosen(), 0);
  return testing::internal::GetCapturedStdout();
}

TEST(PlotCommand, DrawsEvaluationsAndTheActorsEpisodes) {
  const TemporaryFolder folder;
  const RunPlanter run(folder.path() / "a");
  run.Begin();
  run.WriteEvaluation(100, 0.5);
  run.WriteEvaluation(200, 0.95);
  WriteFileAtomically(run.path() / "metrics.jsonl",
                      R"({"role":"coordinator","env_steps":50,"rollout_success":0.25})"
                      "\n");
  const std::string file = folder.path() / "a.svg";
  EXPECT_EQ(Printed(AddPlotCommand, {"plot", run.path().string(), "--output", file}), file + "\n");
  EXPECT_THAT(ReadFile(file), AllOf(HasSubstr("a (1 seed)"), HasSubstr("episodes of the actors")));
}

TEST(PlotCommand, DrawsReferencesByFileOrName) {
  const TemporaryFolder folder;
  const RunPlanter run(folder.path() / "a");
  run.Begin({"task=walker_walk", "env_steps=50000"});
  run.WriteEvaluation(100, 0.5);
  run.WriteEvaluation(200, 0.95);
  const std::string own = folder.path() / "own.json";
  WriteFileAtomically(own, R"({"schema": "shoal-reference-1", "source": "s", "results": [
    {"method": "Theirs", "task": "walker_walk", "frames": [100], "returns": [5]}]})");
  const std::string file = folder.path() / "a.svg";
  Printed(AddPlotCommand, {"plot", run.path().string(), "--output", file, "--x", "frames",
                           "--reference", own, "--reference", "planet-6"});
  EXPECT_THAT(ReadFile(file),
              AllOf(HasSubstr("Theirs"), HasSubstr("DrQ K=M=1"), HasSubstr("environment frames")));
  const std::string page = folder.path() / "a.html";
  Printed(AddReportCommand,
          {"report", run.path().string(), "--output", page, "--reference", "planet-6"});
  EXPECT_THAT(ReadFile(page), HasSubstr("DrQ K=M=1"));
}

TEST(PlotCommand, AReferenceIsGivenOnce) {
  CLI::App app;
  Action chosen;
  AddPlotCommand(app, &chosen);
  std::vector<std::string> words{"plot", "a", "--reference", "planet-6", "--reference", "planet-6"};
  std::ranges::reverse(words);
  app.parse(words);
  EXPECT_EQ(UsageMessage([&] { chosen(); }), "--reference: 'planet-6' is given twice");
}

}  // namespace
}  // namespace shoal::launch
