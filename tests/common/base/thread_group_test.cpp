// SPDX-License-Identifier: Apache-2.0
#include "common/base/thread_group.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/stop.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ThreadGroupTest : public testing::Test {
 protected:
  std::string LogOf(const std::string& name) const { return (folder_.path() / name).string(); }

  TemporaryFolder folder_;
  ThreadGroup one_{"one-0", LogOf("one")}, two_{"two-0", LogOf("two")};
};

TEST_F(ThreadGroupTest, AStopIsTheGroupsOwnAndItsThreadsInheritTheGroup) {
  const int before = StopRequests();  // another test of this process may have asked for one
  one_.RequestStop();
  one_.RequestStop();
  EXPECT_EQ(StopRequests(), before);
  bool stops = false, others = true;
  int requests = 0;
  {
    const ThreadGroup::Member member(&one_);
    EXPECT_EQ(ThreadGroup::Current(), &one_);
    Thread thread([&] {
      stops = StopRequested();
      requests = StopRequests();
    });
    thread.join();
  }
  EXPECT_EQ(ThreadGroup::Current(), nullptr);
  {
    const ThreadGroup::Member member(&two_);
    Thread thread([&] { others = StopRequested(); });
    thread.join();
  }
  EXPECT_TRUE(stops);
  EXPECT_EQ(requests, 2);
  EXPECT_FALSE(others);
}

TEST_F(ThreadGroupTest, LinesGoToTheLogOfTheGroup) {
  {
    const ThreadGroup::Member member(&one_);
    log::Info("of {}", "one");
    log::WriteRaw(one_.log(), "as it is");
    log::Warning("again");
  }
  {
    const ThreadGroup::Member member(&two_);
    log::Failure("of two");
  }
  const std::string one = ReadFile(LogOf("one")), two = ReadFile(LogOf("two"));
  EXPECT_THAT(one, HasSubstr("one-0 info: of one\n"));
  EXPECT_THAT(one, HasSubstr("\nas it is\n"));
  EXPECT_THAT(one, HasSubstr("one-0 warning: again\n"));
  EXPECT_THAT(one, Not(HasSubstr("two")));
  EXPECT_THAT(two, HasSubstr("two-0 error: of two\n"));
}

// Long enough for the clock of a thread to move.
void Compute(double span) {
  const SteadyTime start = Now();
  volatile double sum = 0;
  while (SecondsSince(start) < span) {
    for (int i = 0; i < 1000; ++i) sum = sum + i;
  }
}

TEST_F(ThreadGroupTest, ProcessorTimeIsOfTheMembersAlsoOfThoseThatEnded) {
  Compute(0.02);  // of no group
  EXPECT_EQ(one_.CpuSeconds(), 0);
  {
    const ThreadGroup::Member member(&one_);
    Thread thread([] { Compute(0.05); });
    thread.join();
  }
  const double ended = one_.CpuSeconds();
  EXPECT_GT(ended, 0);
  {
    const ThreadGroup::Member member(&one_);
    Compute(0.05);
    EXPECT_GT(one_.CpuSeconds(), ended);
  }
  EXPECT_EQ(two_.CpuSeconds(), 0);
}

TEST_F(ThreadGroupTest, ALogThatCannotBeOpenedIsNamed) {
  WriteFileAtomically(folder_.path() / "file", "");
  EXPECT_THROW(ThreadGroup("x", LogOf("file/x.log")), Error);
}

}  // namespace
}  // namespace shoal
