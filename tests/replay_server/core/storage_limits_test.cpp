#include "replay_server/core/storage_limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::replay {
namespace {

// A machine's /proc and /sys as files.
class StorageLimitsTest : public testing::Test {
 protected:
  StorageLimitsTest() { Write("proc/meminfo", "MemTotal: 9000 kB\nMemAvailable:    4000 kB\n"); }
  void Write(const std::string& path, const std::string& content) {
    MakeFolders((folder_.path() / path).parent_path());
    WriteFileAtomically(folder_.path() / path, content);
  }
  MemoryRoom Room() { return AvailableMemory(folder_.path()); }

  TemporaryFolder folder_;
};

TEST_F(StorageLimitsTest, WithoutCgroupsTheAvailableMemoryCounts) {
  EXPECT_EQ(Room().bytes, 4000u * 1024);
  EXPECT_EQ(Room().source, "MemAvailable");
}

TEST_F(StorageLimitsTest, ACgroupOfVersion2AroundUsCountsWithItsCacheAsFree) {
  Write("proc/self/cgroup", "0::/outer/inner\n");
  Write("sys/fs/cgroup/outer/inner/memory.max", "max\n");
  Write("sys/fs/cgroup/outer/memory.max", "1000000\n");
  Write("sys/fs/cgroup/outer/memory.current", "700000\n");
  Write("sys/fs/cgroup/outer/memory.stat", "anon 5\ninactive_file 200000\n");
  EXPECT_EQ(Room().bytes, 500'000u);
  EXPECT_EQ(Room().source, (folder_.path() / "sys/fs/cgroup/outer/memory.max").string());
}

TEST_F(StorageLimitsTest, ACgroupOfVersion1Counts) {
  Write("proc/self/cgroup", "5:cpu,cpuacct:/x\n4:memory:/job\n");
  Write("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "300000\n");
  Write("sys/fs/cgroup/memory/job/memory.usage_in_bytes", "400000\n");
  EXPECT_EQ(Room().bytes, 0u);
}

TEST_F(StorageLimitsTest, AGroupAtTheRootOfAContainerCounts) {
  Write("proc/self/cgroup", "0::/\n");
  Write("sys/fs/cgroup/memory.max", "123456\n");
  EXPECT_EQ(Room().bytes, 123'456u);
}

TEST_F(StorageLimitsTest, ThisMachineHasSomeRoom) {
  EXPECT_GT(AvailableMemory().bytes, 1'000'000u);
  CheckMemoryRoom(1000);
  CheckDiskRoom(folder_.path(), 1000);
}

TEST_F(StorageLimitsTest, ARefusalOffersWhatTheCallerCanDo) {
  try {
    CheckMemoryRoom(uint64_t{1} << 60, "move run_dir to a disk");
    FAIL() << "room for an exabyte";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::EndsWith("or move run_dir to a disk"));
  }
}

}  // namespace
}  // namespace shoal::replay
