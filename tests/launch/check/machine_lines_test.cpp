// SPDX-License-Identifier: Apache-2.0
#include "launch/check/machine_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr Needs kNeeds{.ring_bytes = 1'000'000, .process_bytes = 500'000};

TEST(MachineLines, ACpuWithoutAvx2IsAWarning) {
  EXPECT_EQ(JudgeCpu("avx512_core_bf16", "bf16").verdict, Verdict::kOk);
  EXPECT_EQ(JudgeCpu("avx2", "f32").verdict, Verdict::kOk);
  const CheckLine old = JudgeCpu("sse41", "f32");
  EXPECT_EQ(old.verdict, Verdict::kWarn);
  EXPECT_THAT(old.finding, HasSubstr("sse41"));
  EXPECT_THAT(old.advice, HasSubstr("AVX2"));
}

TEST(MachineLines, TheSystemIsNamedAndWhetherItWasTried) {
  const TemporaryFolder folder;
  const auto line = [&](const std::string& text) {
    WriteFileAtomically(folder.path() / "os-release", text);
    const CheckLine judged = JudgeSystem({folder.path() / "absent", folder.path() / "os-release"});
    EXPECT_EQ(judged.verdict, Verdict::kOk);
    return judged.finding;
  };
  EXPECT_EQ(line("PRETTY_NAME=\"Debian GNU/Linux 12 (bookworm)\"\nVERSION_ID=\"12\"\nID=debian\n"),
            "Debian GNU/Linux 12 (bookworm); tested");
  EXPECT_EQ(line("ID='debian'\nVERSION_ID=13\nPRETTY_NAME='Debian GNU/Linux 13'\n"),
            "Debian GNU/Linux 13; tested");
  EXPECT_EQ(line("ID=debian\nVERSION_ID=\"11\"\nPRETTY_NAME=\"Debian GNU/Linux 11\"\n"),
            "Debian GNU/Linux 11; not tested (tested: Debian 12 and 13)");
  EXPECT_EQ(line("ID=ubuntu\nVERSION_ID=\"12\"\nPRETTY_NAME=\"Ubuntu 12\"\n"),
            "Ubuntu 12; not tested (tested: Debian 12 and 13)");
  EXPECT_THAT(line("ID=debian"), AllOf(HasSubstr("unnamed in"), HasSubstr("not tested")));
  EXPECT_THAT(JudgeSystem({folder.path() / "absent"}).finding, HasSubstr("unknown"));
}

TEST(MachineLines, CoresAreTheLeastOfAffinityAndQuota) {
  const auto line = [](int affinity, double quota) {
    return JudgeCores({.online = 8, .affinity = affinity, .quota = quota});
  };
  EXPECT_THAT(line(4, INFINITY).finding, HasSubstr("4 usable of 8"));
  EXPECT_THAT(line(4, INFINITY).finding, HasSubstr("no cgroup quota"));
  EXPECT_THAT(line(4, 2.5).finding, HasSubstr("3 usable of 8"));
  EXPECT_EQ(line(2, INFINITY).verdict, Verdict::kOk);
  EXPECT_EQ(line(1, INFINITY).verdict, Verdict::kWarn);
  EXPECT_EQ(line(8, 0.5).verdict, Verdict::kWarn);
  EXPECT_THAT(line(1, INFINITY).advice, HasSubstr("1 of 8 by its CPU affinity mask"));
  EXPECT_THAT(line(8, 0.5).advice, HasSubstr("0.5 by its cgroup's CPU quota"));
}

TEST(MachineLines, TheRingMustFitOnTheDiskOfTheRunFolder) {
  const TemporaryFolder folder;
  const CheckLine fits = LookAtDisk(folder.path() / "runs" / "deep", kNeeds);
  EXPECT_EQ(fits.verdict, Verdict::kOk);
  EXPECT_THAT(fits.finding, HasSubstr(folder.path().string()));
  Needs huge = kNeeds;
  huge.ring_bytes = uint64_t{1} << 60;
  EXPECT_THROW(LookAtDisk(folder.path(), huge), Error);
}

TEST(MachineLines, TheNearestFolderThatIsThereIsLookedAt) {
  const TemporaryFolder folder;
  EXPECT_EQ(ExistingFolder(folder.path()), folder.path());
  EXPECT_EQ(ExistingFolder(folder.path() / "a" / "b"), folder.path());
  EXPECT_EQ(ExistingFolder("/absent/a"), "/");
}

TEST(MachineLines, MemoryFailsBelowTheProcessesAndWarnsBelowTheRing) {
  EXPECT_EQ(JudgeMemory(2'000'000, "MemAvailable", kNeeds).verdict, Verdict::kOk);
  EXPECT_EQ(JudgeMemory(1'499'999, "MemAvailable", kNeeds).verdict, Verdict::kWarn);
  EXPECT_EQ(JudgeMemory(499'999, "MemAvailable", kNeeds).verdict, Verdict::kFail);
  EXPECT_THAT(JudgeMemory(1, "memory.max", kNeeds).finding, HasSubstr("memory.max"));
}

TEST(MachineLines, NoSharedMemoryIsNeeded) {
  const TemporaryFolder folder;
  EXPECT_THAT(LookAtSharedMemory(folder.path()).finding,
              AllOf(HasSubstr("MB free in"), HasSubstr("none is needed")));
  const CheckLine none = LookAtSharedMemory(folder.path() / "absent");
  EXPECT_EQ(none.verdict, Verdict::kOk);
  EXPECT_THAT(none.finding, HasSubstr("absent"));
}

}  // namespace
}  // namespace shoal::launch
