// SPDX-License-Identifier: Apache-2.0
#include "common/config/run_membership.h"

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/member_process.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

TEST(RunMembership, ARunWithoutProcessesHasNoMember) {
  const TemporaryFolder run;
  EXPECT_EQ(AnyMember(run.path()), std::nullopt);
}

TEST(RunMembership, AMemberIsKnownByItsProcessUntilItDies) {
  const TemporaryFolder run;
  MemberProcess first(run.path());
  EXPECT_EQ(AnyMember(run.path()), first.pid());
  MemberProcess second(run.path());
  first.Kill();
  EXPECT_EQ(AnyMember(run.path()), second.pid()) << "many may be members at once";
  second.Kill();
  EXPECT_EQ(AnyMember(run.path()), std::nullopt);
}

TEST(RunMembership, AFolderThatIsNotThereIsAnErrorNamingIt) {
  try {
    const RunMembership member("/absent/run");
    FAIL() << "became a member";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("/absent/run"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace shoal
