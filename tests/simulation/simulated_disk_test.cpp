// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/simulated_disk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/sleep.h"
#include "tests/simulation/fiber_scheduler.h"
#include "tests/support/temporary_folder.h"

namespace shoal::simulation {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;

constexpr SteadyTime kBeginning{};

class SimulatedDiskTest : public testing::Test {
 protected:
  std::string Log(const char* name) const { return (folder_.path() / name).string(); }
  // The reason of a failed write; empty when the file was written.
  std::string Write(const char* content) {
    try {
      WriteFileAtomically(file_, content);
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  }

  TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "file";
  FiberScheduler scheduler_{1, 1'000'000'000};
  ThreadGroup one_{"one-0", Log("one")}, two_{"two-0", Log("two")};
  SimulatedDisk disk_{1};
};

TEST_F(SimulatedDiskTest, AFullDiskFailsEveryWriteUntilItHasRoomAndLeavesTheOldFile) {
  scheduler_.StartIn(&one_, [&] {
    EXPECT_EQ(Write("old"), "");
    disk_.BeFull(kBeginning + seconds(5));
    EXPECT_THAT(Write("new"), HasSubstr("No space left on device"));
    EXPECT_EQ(ReadFile(file_), "old");
    SleepUntil(kBeginning + seconds(5));
    EXPECT_EQ(Write("new"), "");
  });
  scheduler_.RunUntil(kBeginning + seconds(10));
  EXPECT_EQ(ReadFile(file_), "new");
}

TEST_F(SimulatedDiskTest, AFailingDiskFailsSomeWritesOfOneProcessAtSomeStep) {
  int failed = 0, others = 0;
  disk_.Fail(&one_, kBeginning + seconds(100));
  scheduler_.StartIn(&one_, [&] {
    for (int i = 0; i < 40; ++i) failed += Write("one").empty() ? 0 : 1;
  });
  scheduler_.StartIn(&two_, [&] {
    for (int i = 0; i < 40; ++i) {
      try {
        WriteFileAtomically(folder_.path() / "other", "two");
      } catch (const Error&) {
        ++others;
      }
    }
  });
  scheduler_.RunUntil(kBeginning + seconds(50));
  EXPECT_GT(failed, 20);
  EXPECT_LT(failed, 40);
  EXPECT_EQ(others, 0);
}

TEST_F(SimulatedDiskTest, AKillBetweenTwoStepsLeavesAHalfWrittenTemporaryFile) {
  bool half = false;
  for (int i = 0; i < 200 && !half; ++i) {
    ThreadGroup group("victim-0", Log("victim"));
    scheduler_.StartIn(&group, [&] {
      while (true) {
        Write("0123456789");
        SleepFor(milliseconds(1));
      }
    });
    scheduler_.RunUntil(scheduler_.NowOutside() + milliseconds(37 + i));
    scheduler_.Kill(&group);
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename();
      half = half || (name.starts_with("file.tmp-") && entry.file_size() == 5);
    }
  }
  EXPECT_TRUE(half);
  EXPECT_EQ(ReadFile(file_), "0123456789");
}

}  // namespace
}  // namespace shoal::simulation
