// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/exit_reason.h"

#include <gtest/gtest.h>

#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

const std::string kTold = "2026-01-31 12:00:00.000 learner-0 info: session 17: sac, bf16\n";
const std::string kWarned =
    "2026-01-31 12:00:01.000 learner-0 warning: the coordinator is silent\n";
const std::string kFailed = "2026-01-31 12:00:02.000 learner-0 error: no space left\n";

class ExitReasonTest : public ::testing::Test {
 protected:
  std::string After(const std::string& text, uintmax_t from = 0) {
    WriteFileAtomically(folder_.path() / "log", text);
    return ExitReason(folder_.path() / "log", from);
  }
  TemporaryFolder folder_;
};

TEST_F(ExitReasonTest, WhatALogTellsIsNoReason) {
  EXPECT_EQ(After(kTold), "");
  EXPECT_EQ(After(""), "");
  EXPECT_EQ(ExitReason(folder_.path() / "none", 0), "");
}

TEST_F(ExitReasonTest, TheLastErrorIs) {
  EXPECT_EQ(After(kFailed + kTold + kWarned), "no space left");
  EXPECT_EQ(After(kTold + "terminate called\n\n"), "terminate called") << "not of the log";
  EXPECT_EQ(After("shoal-actor: error: no model\n" + kTold), "shoal-actor: error: no model");
}

TEST_F(ExitReasonTest, AWarningStandsInForAnError) {
  EXPECT_EQ(After(kWarned + kTold), "the coordinator is silent");
}

TEST_F(ExitReasonTest, FormerProcessesHaveNoSay) {
  EXPECT_EQ(After(kFailed + kTold, kFailed.size()), "");
  EXPECT_EQ(After(kFailed + kWarned, kFailed.size()), "the coordinator is silent");
}

}  // namespace
}  // namespace shoal::launch
