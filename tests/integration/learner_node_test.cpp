// SPDX-License-Identifier: Apache-2.0
// A learner on a machine with two NUMA nodes: /sys says so, whatever the machine really has.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>

#include <algorithm>
#include <string>
#include <vector>

#include "common/base/numa_nodes.h"
#include "common/base/usable_cores.h"
#include "tests/support/isolation.h"
#include "tests/support/run_views.h"
#include "tests/support/running_training.h"

namespace shoal {
namespace {

using std::chrono::seconds;
using ::testing::HasSubstr;

std::vector<int> CpusOfThread(pid_t thread) {
  cpu_set_t set;
  CPU_ZERO(&set);
  EXPECT_EQ(sched_getaffinity(thread, sizeof set, &set), 0);
  std::vector<int> cpus;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(size_t(cpu), &set)) cpus.push_back(cpu);
  }
  return cpus;
}

// For this process and those that it starts, the machine has two nodes, each with half of the CPUs.
// Returns "" or the reason why that cannot be done here.
std::string HaveTwoNodes(const std::vector<int>& cpus, const std::filesystem::path& folder) {
  if (std::string no = OwnMounts(); !no.empty()) return no;
  std::string lists[2];
  for (size_t i = 0; i < cpus.size(); ++i) {
    std::string& list = lists[2 * i / cpus.size()];
    list += (list.empty() ? "" : ",") + std::to_string(cpus[i]);
  }
  for (int node = 0; node < 2; ++node) {
    const std::filesystem::path of_node = folder / ("node" + std::to_string(node));
    MakeFolders(of_node);
    WriteFileAtomically(of_node / "cpulist", lists[node] + "\n");
  }
  const bool mounted =
      mount(folder.c_str(), "/sys/devices/system/node", nullptr, MS_BIND, nullptr) == 0;
  return mounted ? "" : Because("mount");
}

TEST(LearnerNode, TheLearnerStaysOnANodeWhileItsThreadsFit) {
  if (UsableCores() < 2) GTEST_SKIP() << "needs two cores";
  const std::vector<int> all = CpusOfThread(0);
  const TemporaryFolder folder;
  if (const std::string no = HaveTwoNodes(all, folder.path()); !no.empty()) GTEST_SKIP() << no;
  const std::vector<NumaNode> nodes = ReadNumaNodes(all);
  ASSERT_EQ(nodes.size(), 2u);
  const NumaNode* node = NodeFor(1, nodes);
  ASSERT_NE(node, nullptr);
  const int many = UsableCores();
  // A control group may allow fewer cores than one node has.
  if (many <= node->cores) GTEST_SKIP() << "needs more than " << node->cores << " cores";

  const TrainingRun run;
  RunningTraining training(run, run.Command({{"env_steps", "10000000"}, {"actors", "1"}}));
  const nlohmann::json view = WaitForView(run, Learns);
  ASSERT_TRUE(view.is_object()) << training.Output();
  const pid_t learner = ProcessOf(view, "learner").at("pid").get<pid_t>();
  EXPECT_EQ(CpusOfThread(learner), node->cpus);
  EXPECT_EQ(CpusOfThread(ProcessOf(view, "actor").at("pid").get<pid_t>()), all);

  const ProgramResult more = RunShoal(run, {"set", "learner.threads=" + std::to_string(many)});
  EXPECT_EQ(ExitCode(more), 0) << more.err << "the learner counts the cores of all nodes";
  EXPECT_EQ(CpusOfThread(learner), all);
  EXPECT_EQ(ExitCode(RunShoal(run, {"set", "learner.threads=1"})), 0);
  EXPECT_EQ(CpusOfThread(learner), node->cpus);

  training.Interrupt();
  EXPECT_EQ(training.End(seconds(120)), kInterruptedExit) << training.Output();
  const std::string log = ReadFile(run.path() / "logs/learner-0.log");
  EXPECT_THAT(log, HasSubstr("the learner stays on NUMA node 0"));
  EXPECT_THAT(log, HasSubstr("the learner uses all"));
}

}  // namespace
}  // namespace shoal
