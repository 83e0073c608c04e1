// SPDX-License-Identifier: Apache-2.0
// OpenMP variables that a site exports for every program must not bind a run to one core.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "common/base/numa_nodes.h"
#include "common/base/usable_cores.h"
#include "tests/support/processes.h"
#include "tests/support/roomy_folder.h"
#include "tests/support/running_training.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;
using testing::HasSubstr;

// The masks of all threads of a process, as /proc writes them: "0-7".
std::set<std::string> MasksOf(pid_t pid) {
  constexpr std::string_view kName = "Cpus_allowed_list:\t";
  std::set<std::string> masks;
  std::error_code error;
  for (const auto& task : fs::directory_iterator("/proc/" + std::to_string(pid) + "/task", error)) {
    std::ifstream in(task.path() / "status");
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with(kName)) masks.insert(line.substr(kName.size()));
    }
  }
  return masks;
}

std::string OwnMask() {
  const std::set<std::string> masks = MasksOf(getpid());
  EXPECT_EQ(masks.size(), 1u);
  return *masks.begin();
}

// Binds this process and its later children to one core.
void UseOneCore() {
  cpu_set_t set;
  CPU_ZERO(&set);
  ASSERT_EQ(sched_getaffinity(0, sizeof set, &set), 0);
  size_t core = 0;
  while (!CPU_ISSET(core, &set)) ++core;
  CPU_ZERO(&set);
  CPU_SET(core, &set);
  ASSERT_EQ(sched_setaffinity(0, sizeof set, &set), 0);
}

// The masks that a process of a run may have: this process's, and for the learner, which stays on
// one NUMA node if it fits there, those of the nodes.
std::vector<std::vector<int>> ExpectedMasks(bool learner) {
  std::vector<std::vector<int>> masks{ParseCpuList(OwnMask(), "own mask")};
  if (!learner) return masks;
  for (const NumaNode& node : ReadNumaNodes(masks[0])) masks.push_back(node.cpus);
  return masks;
}

// Trains until every process has done work, and compares their masks with this process's.
void ExpectMasksKept(const RunningTraining::Environment& environment) {
  const TrainingRun run;
  RunningTraining training(run, run.Command({{"env_steps", "10000000"}, {"actors", "1"}}),
                           environment);
  ASSERT_TRUE(training.WaitForMoreSteps(500)) << training.Output();
  ASSERT_FALSE(training.reports().Await("eval").is_null()) << training.Output();
  ASSERT_FALSE(training.reports()
                   .WaitFor("learner", [](const auto& r) { return r.value("updates", 0.0) > 10; })
                   .is_null());
  std::vector<pid_t> processes = ChildrenOf(training.pid());
  EXPECT_EQ(processes.size(), 4u) << "replay, learner, actor, evaluation actor";
  processes.push_back(training.pid());
  for (const pid_t process : processes) {
    const std::string program = CommandLine(process)[0];
    const auto expected = ExpectedMasks(program.ends_with("shoal-learner"));
    const std::set<std::string> masks = MasksOf(process);
    EXPECT_FALSE(masks.empty()) << program;
    for (const std::string& mask : masks) {
      EXPECT_THAT(expected, testing::Contains(ParseCpuList(mask, program))) << program;
    }
  }
  for (const auto& [name, value] : environment) {
    EXPECT_THAT(training.Output(), HasSubstr(name + "=" + value + " is ignored"));
  }
  training.Interrupt();
  EXPECT_EQ(training.End(seconds(100)), kInterruptedExit) << training.Output();
}

TEST(OpenMpBinding, ProcBindAndPlacesLeaveEveryProcessItsCores) {
  if (UsableCores() < 2) GTEST_SKIP() << "needs two cores";
  ExpectMasksKept({{"OMP_PROC_BIND", "true"}, {"OMP_PLACES", "cores"}});
}

TEST(OpenMpBinding, CpuAffinityLeavesEveryProcessItsCores) {
  if (UsableCores() < 2) GTEST_SKIP() << "needs two cores";
  ExpectMasksKept({{"GOMP_CPU_AFFINITY", "0"}});
}

TEST(OpenMpBinding, TheMaskThatTheUserSetHolds) {
  UseOneCore();
  ExpectMasksKept({{"OMP_PROC_BIND", "spread"}});
}

TEST(OpenMpBinding, ThreadsWithoutCoresAreRefusedWithTheReason) {
  if (UsableCores() < 2) GTEST_SKIP() << "needs two cores";
  const std::vector<std::string> command{
      ProgramPath("shoal"), "train",     "--preset",
      "fetch-reach-fast",   "--dry-run", "--set",
      "learner.threads=2",  "--set",     "run_dir=" + RoomyFolder().string()};
  const ProgramResult bound = RunCommand(command, seconds(60), {{"OMP_PROC_BIND", "true"}});
  EXPECT_EQ(ExitCode(bound), 0) << "the variable takes no core away: " << bound.err;
  UseOneCore();
  const ProgramResult refused = RunCommand(command, seconds(60), {{"OMP_PROC_BIND", "true"}});
  EXPECT_EQ(ExitCode(refused), 2);
  EXPECT_THAT(refused.err, HasSubstr("this process may use 1 core: 1 of "));
  EXPECT_THAT(refused.err, HasSubstr("which OMP_PROC_BIND=true may have bound"));
  const ProgramResult check =
      RunCommand({ProgramPath("shoal"), "check", "--run-dir", RoomyFolder().string()}, seconds(100),
                 {{"OMP_PROC_BIND", "true"}});
  EXPECT_THAT(check.out, HasSubstr("OMP_PROC_BIND=true is ignored"));
  EXPECT_THAT(check.out, HasSubstr("by its CPU affinity mask"));
}

}  // namespace
}  // namespace shoal
