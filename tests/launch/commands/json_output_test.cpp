// SPDX-License-Identifier: Apache-2.0
#include "launch/commands/json_output.h"

#include <gtest/gtest.h>

#include "common/base/files.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

TEST(JsonOutput, AFileGetsTheJsonAndStandardOutputTheText) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "x.json";
  const JsonOutput output(file);
  EXPECT_EQ(output.text(), stdout);
  output.WriteEarly("early");
  EXPECT_EQ(ReadFile(file), "early");
  output.Write("{}\n");
  EXPECT_EQ(ReadFile(file), "{}\n");
}

TEST(JsonOutput, ADashIsStandardOutputWhichThenHoldsNothingElse) {
  const JsonOutput output("-");
  EXPECT_EQ(output.text(), stderr);
  testing::internal::CaptureStdout();
  output.WriteEarly("early");
  output.Write("{}\n");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "{}\n");
}

TEST(JsonOutput, WithoutAFileNothingIsWritten) {
  const JsonOutput output("");
  EXPECT_EQ(output.text(), stdout);
  testing::internal::CaptureStdout();
  output.WriteEarly("early");
  output.Write("{}\n");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(JsonOutput, AFileThatCannotBeWrittenIsRefusedAtOnce) {
  EXPECT_NE(ErrorMessage(1, [] { JsonOutput("/absent/x.json"); }).find("/absent/x.json"),
            std::string::npos);
}

}  // namespace
}  // namespace shoal::launch
