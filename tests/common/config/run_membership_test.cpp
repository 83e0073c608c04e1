#include "common/config/run_membership.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "common/base/error.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

// A process that is a member of `run` until it is killed. The test ends when it cannot become one.
class MemberProcess {
 public:
  explicit MemberProcess(const std::filesystem::path& run) {
    int ready[2];
    EXPECT_EQ(pipe(ready), 0);
    pid_ = fork();
    if (pid_ == 0) {
      const RunMembership member(run);
      [[maybe_unused]] const ssize_t written = write(ready[1], "x", 1);
      while (true) pause();
    }
    char byte = 0;
    EXPECT_EQ(read(ready[0], &byte, 1), 1);
    close(ready[0]);
    close(ready[1]);
  }
  ~MemberProcess() { Kill(); }
  pid_t pid() const { return pid_; }
  void Kill() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }

 private:
  pid_t pid_ = -1;
};

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
