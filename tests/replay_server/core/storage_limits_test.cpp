// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/storage_limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/files.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::replay {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;

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

TEST_F(StorageLimitsTest, ARingOfAllThatIsAvailableFitsAndNotAByteMore) {
  const auto refusal = [&](uint64_t bytes) {
    return ErrorMessage([&] { CheckMemoryRoom(bytes, "move run_dir to a disk", folder_.path()); });
  };
  EXPECT_EQ(refusal(4000u * 1024), "");
  EXPECT_THAT(refusal(4000u * 1024 + 1), AllOf(HasSubstr("4 MB are available (MemAvailable)"),
                                               EndsWith("or move run_dir to a disk")));
}

}  // namespace
}  // namespace shoal::replay
