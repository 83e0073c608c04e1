// SPDX-License-Identifier: Apache-2.0
// The threads of this process on a machine whose two nodes are a folder's, a CPU each.
#include "learner/node_affinity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <thread>

#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::learner {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<int> MaskOf(pid_t thread) {
  cpu_set_t set;
  CPU_ZERO(&set);
  EXPECT_EQ(sched_getaffinity(thread, sizeof set, &set), 0);
  std::vector<int> cpus;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(size_t(cpu), &set)) cpus.push_back(cpu);
  }
  return cpus;
}

void SetOwnMask(const std::vector<int>& cpus) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int cpu : cpus) CPU_SET(size_t(cpu), &set);
  ASSERT_EQ(sched_setaffinity(0, sizeof set, &set), 0);
}

// Waits until it is destroyed.
class IdleThread {
 public:
  IdleThread() { id_.wait(0); }
  ~IdleThread() {
    ends_ = true;
    ends_.notify_all();
    thread_.join();
  }
  IdleThread(const IdleThread&) = delete;
  IdleThread& operator=(const IdleThread&) = delete;

  pid_t id() const { return id_; }

 private:
  std::atomic<pid_t> id_{0};
  std::atomic<bool> ends_{false};
  std::thread thread_{[this] {
    id_ = gettid();
    id_.notify_all();
    ends_.wait(false);
  }};
};

class NodeAffinityTest : public testing::Test {
 protected:
  void SetUp() override {
    if (before_.size() < 2) GTEST_SKIP() << "needs two cores";
    SetOwnMask(both_);
    WriteNode(0, both_[0]);
    WriteNode(1, both_[1]);
  }
  void TearDown() override { SetOwnMask(before_); }

  void WriteNode(int number, int cpu) {
    const std::string n = std::to_string(number), c = std::to_string(cpu);
    Write("node/node" + n + "/cpulist", c + "\n");
    Write("cpu/cpu" + c + "/topology/thread_siblings_list", c + "\n");
  }
  void Write(const std::string& path, const std::string& content) {
    const std::filesystem::path file = folder_.path() / "sys/devices/system" / path;
    MakeFolders(file.parent_path());
    WriteFileAtomically(file, content);
  }

  const std::vector<int> before_ = MaskOf(0);
  const std::vector<int> both_{before_.begin(),
                               before_.begin() + std::min<ptrdiff_t>(2, ssize(before_))};
  TemporaryFolder folder_;
};

TEST_F(NodeAffinityTest, ThreadsThatBeginLaterFollowTheNumberOfThreads) {
  const IdleThread earlier;
  NodeAffinity affinity(folder_.path());
  testing::internal::CaptureStderr();
  affinity.FitTo(1);
  const IdleThread later;
  EXPECT_THAT(MaskOf(0), ElementsAre(both_[0]));
  EXPECT_THAT(MaskOf(later.id()), ElementsAre(both_[0]));
  EXPECT_EQ(MaskOf(earlier.id()), both_) << "it receives messages";
  EXPECT_EQ(affinity.Limits().affinity, 2) << "as many threads as CPUs can be asked for";
  affinity.FitTo(2);
  EXPECT_EQ(MaskOf(0), both_);
  EXPECT_EQ(MaskOf(later.id()), both_);
  affinity.FitTo(1);
  EXPECT_THAT(MaskOf(later.id()), ElementsAre(both_[0]));
  EXPECT_EQ(MaskOf(earlier.id()), both_);
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_THAT(log, HasSubstr("the learner stays on NUMA node 0: 1 of 2 CPUs"));
  EXPECT_THAT(log, HasSubstr("the learner uses all 2 CPUs: no NUMA node has 2 cores"));
}

TEST_F(NodeAffinityTest, EachChangeIsOneLine) {
  NodeAffinity affinity(folder_.path());
  testing::internal::CaptureStderr();
  affinity.FitTo(2);
  affinity.FitTo(2);
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::ranges::count(log, '\n'), 1) << log;
}

TEST_F(NodeAffinityTest, AMaskOfOneNodeIsLeftAlone) {
  SetOwnMask({both_[1]});
  NodeAffinity affinity(folder_.path());
  testing::internal::CaptureStderr();
  affinity.FitTo(1);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_THAT(MaskOf(0), ElementsAre(both_[1]));
  EXPECT_EQ(affinity.Limits().affinity, 1);
}

TEST_F(NodeAffinityTest, AMaskThatIsSetLaterIsTheLimitFromThenOn) {
  NodeAffinity affinity(folder_.path());
  affinity.FitTo(1);
  SetOwnMask({both_[1]});
  EXPECT_EQ(affinity.Limits().affinity, 1);
  affinity.FitTo(2);
  EXPECT_THAT(MaskOf(0), ElementsAre(both_[1]));
}

TEST_F(NodeAffinityTest, AListThatCannotBeReadIsAWarning) {
  Write("node/node1/cpulist", "none\n");
  NodeAffinity affinity(folder_.path());
  testing::internal::CaptureStderr();
  affinity.FitTo(1);
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              HasSubstr("the learner may use several NUMA nodes: "));
  EXPECT_EQ(MaskOf(0), both_);
}

}  // namespace
}  // namespace shoal::learner
