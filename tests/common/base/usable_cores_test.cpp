// SPDX-License-Identifier: Apache-2.0
#include "common/base/usable_cores.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

// A machine's /proc and /sys as files.
class CoreLimitsTest : public testing::Test {
 protected:
  void Write(const std::string& path, const std::string& content) {
    MakeFolders((folder_.path() / path).parent_path());
    WriteFileAtomically(folder_.path() / path, content);
  }
  double Quota() { return ReadCoreLimits(folder_.path()).quota; }

  TemporaryFolder folder_;
};

TEST_F(CoreLimitsTest, WithoutCgroupsThereIsNoQuota) { EXPECT_TRUE(std::isinf(Quota())); }

TEST_F(CoreLimitsTest, TheLeastQuotaOfTheGroupsAroundTheProcessHolds) {
  Write("proc/self/cgroup", "0::/slurm/job_7/step_0\n");
  Write("sys/fs/cgroup/slurm/job_7/step_0/cpu.max", "max 100000\n");
  EXPECT_TRUE(std::isinf(Quota()));
  Write("sys/fs/cgroup/slurm/job_7/cpu.max", "250000 100000\n");
  EXPECT_EQ(Quota(), 2.5);
  Write("sys/fs/cgroup/slurm/cpu.max", "400000 100000\n");
  EXPECT_EQ(Quota(), 2.5);
  Write("sys/fs/cgroup/slurm/job_7/step_0/cpu.max", "50000 100000\n");
  EXPECT_EQ(Quota(), 0.5);
}

TEST_F(CoreLimitsTest, AGroupAtTheRootOfAContainerCounts) {
  Write("proc/self/cgroup", "0::/\n");
  Write("sys/fs/cgroup/cpu.max", "150000 100000\n");
  EXPECT_EQ(Quota(), 1.5);
}

TEST_F(CoreLimitsTest, AGroupOfVersion1Counts) {
  Write("proc/self/cgroup", "5:cpu,cpuacct:/x/y\n4:memory:/job\n");
  Write("sys/fs/cgroup/cpu/x/y/cpu.cfs_quota_us", "-1\n");
  Write("sys/fs/cgroup/cpu/x/y/cpu.cfs_period_us", "100000\n");
  EXPECT_TRUE(std::isinf(Quota()));
  Write("sys/fs/cgroup/cpu/x/cpu.cfs_quota_us", "300000\n");
  Write("sys/fs/cgroup/cpu/x/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(Quota(), 3);
}

TEST(UsableCores, AreTheAffinityCutToTheQuotaRoundedUp) {
  const auto cores = [](int affinity, double quota) {
    return UsableCores({.online = 8, .affinity = affinity, .quota = quota});
  };
  EXPECT_EQ(cores(4, INFINITY), 4);
  EXPECT_EQ(cores(4, 2.5), 3);
  EXPECT_EQ(cores(2, 6), 2);
  EXPECT_EQ(cores(8, 0.1), 1);
  EXPECT_GE(UsableCores(), 1);
  EXPECT_LE(UsableCores(), sysconf(_SC_NPROCESSORS_ONLN));
}

TEST(DescribeLimits, NamesWhatLeavesFewerCoresThanThereAre) {
  EXPECT_EQ(DescribeLimits({.online = 8, .affinity = 8, .quota = INFINITY}), "");
  EXPECT_EQ(DescribeLimits({.online = 8, .affinity = 8, .quota = 16}), "");
  EXPECT_EQ(DescribeLimits({.online = 8, .affinity = 1, .quota = INFINITY}),
            "1 of 8 by its CPU affinity mask (set by taskset, a scheduler or the program that "
            "started it)");
  EXPECT_EQ(DescribeLimits({.online = 8, .affinity = 8, .quota = 2.5}),
            "2.5 by its cgroup's CPU quota");
  const std::string both = DescribeLimits({.online = 8, .affinity = 4, .quota = 1});
  EXPECT_THAT(both, ::testing::HasSubstr("4 of 8 by its CPU affinity mask"));
  EXPECT_THAT(both, ::testing::HasSubstr(", 1 by its cgroup's CPU quota"));
}

}  // namespace
}  // namespace shoal
