// SPDX-License-Identifier: Apache-2.0
// After SIGKILL of the coordinator its processes store their records, write a checkpoint and exit.
// The run continues with --resume, and its account balances.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include "common/wire/control_state.h"
#include "tests/support/processes.h"
#include "tests/support/running_training.h"

namespace shoal {
namespace {

using nlohmann::json;
using std::chrono::seconds;

// Time after the coordinator's death: the lease, the replay's last acknowledgements to actors that
// still send, and a margin for a loaded machine.
constexpr seconds kLeave = ControlState::kLease + seconds(15);

std::vector<std::string> ResumeCommand(const TrainingRun& run) {
  return {"shoal", "train", "--resume", run.path().string(), "--set", "env_steps=9000"};
}

// Whether an adopted orphan ended cleanly: by itself, or by the SIGHUP for its parent's death.
bool EndedInOrder(pid_t pid) {
  int status = 0;
  EXPECT_EQ(waitpid(pid, &status, 0), pid);
  return WIFEXITED(status) || WTERMSIG(status) == SIGHUP;
}

TEST(CoordinatorKill, ProcessesLeaveInOrderAndAResumeAtOnceWaitsForThemAndGoesOn) {
  prctl(PR_SET_CHILD_SUBREAPER, 1);  // orphans become ours: their exit codes can be read
  const TrainingRun run;
  const TrainingRun::Keys keys{
      {"env_steps", "1000000"}, {"actors", "2"}, {"eval.interval", "2000"}};
  RunningTraining training(run, run.Command(keys));
  ASSERT_TRUE(training.WaitForSteps(4000)) << training.Output();
  const auto updates_before =
      static_cast<uint64_t>(training.reports().Await("learner").value("updates", 0.0));
  const std::vector<pid_t> orphans = ChildrenOf(training.pid());
  EXPECT_EQ(orphans.size(), 5u) << "replay, learner, two actors, evaluation actor";
  ASSERT_EQ(kill(training.pid(), SIGKILL), 0);
  EXPECT_EQ(training.End(seconds(5)), -1);
  RunningTraining resumed(run, ResumeCommand(run));
  for (const pid_t pid : orphans) {
    const std::vector<std::string> command = CommandLine(pid);
    ASSERT_TRUE(WaitUntilEnded(pid, kLeave)) << (command.empty() ? "?" : command[0]);
    EXPECT_TRUE(EndedInOrder(pid)) << (command.empty() ? "?" : command[0]);
  }
  EXPECT_NE(ReadFile(run.path() / "logs" / "replay-0.log").find("coordinator is gone"),
            std::string::npos);
  ASSERT_EQ(resumed.End(seconds(240)), 0) << resumed.Output();
  EXPECT_NE(resumed.Output().find("waiting up to 60 s"), std::string::npos) << resumed.Output();
  const json meta = run.Json("meta.json");
  ExpectBalanced(meta);
  EXPECT_EQ(meta.at("accounting").at("lost_with_process"), 0) << "everything made was stored";
  EXPECT_GE(meta.at("env_steps").get<int64_t>(), 9000);
  EXPECT_GE(meta.at("updates").get<uint64_t>(), updates_before) << "from the orphans' checkpoint";
  EXPECT_NE(ReadFile(run.path() / "logs" / "learner-0.log").find("restored step_"),
            std::string::npos);
}

TEST(CoordinatorKill, AStopThatWaitsSaysSo) {
  const TrainingRun run;
  RunningTraining training(run, run.Command({{"env_steps", "1000000"}, {"actors", "1"}}));
  // The run cannot end in this time, because its learner does not exit.
  const pid_t learner = training.reports().Await("learner").at("pid").get<pid_t>();
  ASSERT_EQ(kill(learner, SIGSTOP), 0);
  launch::ProcessSpec spec;
  spec.command = {ProgramPath("shoal"), "stop", "--run", run.path().string()};
  spec.output = run.parent() / "stop";
  launch::ChildProcess stop(spec);
  const SteadyTime start = Now();
  while (ReadFile(spec.output).find("stopping") == std::string::npos) {
    ASSERT_LT(SecondsSince(start), 30);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  ASSERT_EQ(kill(training.pid(), SIGKILL), 0);
  EXPECT_EQ(training.End(seconds(5)), -1);
  std::optional<launch::ExitStatus> status;
  while (!(status = stop.Poll()) && SecondsSince(start) < 60) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  kill(learner, SIGCONT);
  ASSERT_TRUE(status.has_value()) << "still waiting";
  EXPECT_EQ(status->code, 1);
  EXPECT_NE(ReadFile(spec.output).find("silent for 15 s"), std::string::npos);
}

TEST(CoordinatorKill, ARunThatIsInterruptedInsteadIsNotEvaluated) {
  const TrainingRun run;
  RunningTraining training(run, run.Command({{"env_steps", "1000000"}, {"actors", "1"}}));
  ASSERT_TRUE(training.WaitForSteps(2000)) << training.Output();
  training.Interrupt();
  ASSERT_EQ(training.End(seconds(60)), kInterruptedExit) << training.Output();
  EXPECT_FALSE(std::filesystem::exists(run.path() / "eval/final.json"));
  EXPECT_NE(training.Output().find("continue with shoal train --resume"), std::string::npos)
      << training.Output();
  EXPECT_EQ(run.Json("meta.json").at("exit"), "interrupted");
}

}  // namespace
}  // namespace shoal
