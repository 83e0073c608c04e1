// SPDX-License-Identifier: Apache-2.0
// A run on the terminal that it was started on: what its keys do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <thread>
#include <vector>

#include "common/base/stop.h"
#include "tests/support/processes.h"
#include "tests/support/run_views.h"
#include "tests/support/terminal_program.h"

namespace shoal {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using ::testing::HasSubstr;

const TrainingRun::Keys kLong{
    {"env_steps", "10000000"}, {"actors", "1"}, {"eval.interval", "100000"}};

constexpr char kCtrlC[] = "\x03", kCtrlZ[] = "\x1a";

std::vector<pid_t> PidsOf(const json& view) {
  std::vector<pid_t> pids;
  for (const json& process : view.at("processes")) pids.push_back(process.at("pid").get<pid_t>());
  return pids;
}

// Waits until all processes are stopped, or until none is.
bool WaitUntilStopped(const std::vector<pid_t>& pids, bool stopped) {
  const SteadyTime end = Now() + seconds(30);
  while (Now() < end) {
    if (std::ranges::all_of(pids, [&](pid_t p) { return (ProcessState(p) == 'T') == stopped; })) {
      return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

TEST(Terminal, CtrlCLeavesNothingOfItsEchoInTheLinesThatFollow) {
  const TrainingRun run;
  TerminalProgram training(run.Command(kLong));
  ASSERT_TRUE(training.WaitFor("  flow       ", seconds(60))) << training.shown();
  training.Type(kCtrlC);
  ASSERT_TRUE(training.WaitFor("^C\r", seconds(30))) << training.shown();
  EXPECT_TRUE(training.WaitFor("\x1b[Jstopping the run", seconds(30))) << training.shown();
  EXPECT_EQ(training.End(seconds(120)), kInterruptedExit) << training.shown();
  EXPECT_TRUE(training.LeftAsItWas());
}

TEST(Terminal, CtrlZPausesEveryProcessOfTheRun) {
  const TrainingRun run;
  TerminalProgram training(run.Command(kLong));
  // Coordinator, replay, learner, actor, evaluation actor.
  const json view =
      WaitForView(run, [](const json& v) { return Learns(v) && PidsOf(v).size() == 5; });
  ASSERT_TRUE(view.is_object()) << training.shown();
  training.Type(kCtrlZ);
  EXPECT_TRUE(WaitUntilStopped(PidsOf(view), true));
  const ProgramResult top = RunShoal(run, {"top", "--once", "--run", "run"});
  EXPECT_EQ(ExitCode(top), 1);
  EXPECT_THAT(top.err, HasSubstr("it may be paused"));
  training.Signal(SIGCONT);
  EXPECT_TRUE(WaitUntilStopped(PidsOf(view), false));
  EXPECT_TRUE(training.WaitFor("goes on after a pause", seconds(30))) << training.shown();
  const auto steps = view.at("env_steps").get<int64_t>();
  const json later = WaitForView(run, [&](const json& v) { return v.at("env_steps") > steps; });
  ASSERT_TRUE(later.is_object());
  EXPECT_EQ(PidsOf(later), PidsOf(view)) << "no process was taken for dead";
  training.Type(kCtrlC);
  EXPECT_EQ(training.End(seconds(120)), kInterruptedExit) << training.shown();
  const json meta = run.Json("meta.json");
  ExpectBalanced(meta);
  EXPECT_EQ(meta.at("restarts"), 0);
}

}  // namespace
}  // namespace shoal
