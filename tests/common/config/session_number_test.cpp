// SPDX-License-Identifier: Apache-2.0
#include "common/config/session_number.h"

#include <gtest/gtest.h>

#include <cerrno>

#include "common/base/disk_steps.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

TEST(SessionNumber, IsTheClockWhileItGoesForward) {
  const TemporaryFolder run;
  EXPECT_EQ(NextSession(run.path(), "actor-0", 1000), 1000u);
  EXPECT_EQ(NextSession(run.path(), "actor-0", 2000), 2000u);
}

TEST(SessionNumber, StillGrowsAfterTheClockWasSetBack) {
  const TemporaryFolder run;
  EXPECT_EQ(NextSession(run.path(), "replay-0", 5000), 5000u);
  EXPECT_EQ(NextSession(run.path(), "replay-0", 10), 5001u);
  EXPECT_EQ(NextSession(run.path(), "replay-0", -7), 5002u);
  EXPECT_EQ(NextSession(run.path(), "replay-0", 6000), 6000u);
}

TEST(SessionNumber, EachProcessHasItsOwn) {
  const TemporaryFolder run;
  EXPECT_EQ(NextSession(run.path(), "actor-0", 5000), 5000u);
  EXPECT_EQ(NextSession(run.path(), "actor-1", 10), 10u);
}

TEST(SessionNumber, ADamagedFileIsRefusedByName) {
  const TemporaryFolder run;
  NextSession(run.path(), "actor-0", 5000);
  for (const char* content : {"", "50", "50x\n", "-3\n", "99999999999999999999999\n"}) {
    WriteFileAtomically(run.path() / "sessions" / "actor-0", content);
    try {
      NextSession(run.path(), "actor-0", 5000);
      ADD_FAILURE() << "took '" << content << "'";
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("sessions/actor-0"), std::string::npos) << e.what();
    }
  }
}

// A process that starts twice on a full disk after the clock was set back: the second number must
// exceed the first.
TEST(SessionNumber, GrowsOnAFullDiskToo) {
  struct FullDisk final : DiskSteps {
    FullDisk() { SetCurrent(this); }
    ~FullDisk() override { SetCurrent(nullptr); }
    int Before(const std::string&) override { return ENOSPC; }
  };
  const TemporaryFolder run;
  EXPECT_EQ(NextSession(run.path(), "replay-0", 5000), 5000u);
  const FullDisk full;
  EXPECT_EQ(NextSession(run.path(), "replay-0", 6000), 6000u);
  EXPECT_EQ(NextSession(run.path(), "replay-0", 10), 6001u);
}

TEST(SessionNumber, AFolderThatCannotBeWrittenIsNoReasonNotToStart) {
  const TemporaryFolder run;
  WriteFileAtomically(run.path() / "sessions", "no folder");
  EXPECT_EQ(NextSession(run.path(), "actor-0", 5000), 5000u);
}

}  // namespace
}  // namespace shoal
