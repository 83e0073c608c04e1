// SPDX-License-Identifier: Apache-2.0
#include "common/base/stop_with_input.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "common/base/stop.h"
#include "tests/launch/wait_until.h"

namespace shoal {
namespace {

// Standard input is a pipe of the test's while this lives.
class PipedInput {
 public:
  PipedInput() : before_(dup(STDIN_FILENO)) {
    EXPECT_EQ(pipe(ends_), 0);
    dup2(ends_[0], STDIN_FILENO);
    close(ends_[0]);
  }
  ~PipedInput() {
    dup2(before_, STDIN_FILENO);
    close(before_);
  }
  void Write() { EXPECT_EQ(write(ends_[1], "word", 4), 4); }
  void End() { close(ends_[1]); }

 private:
  int before_, ends_[2];
};

TEST(StopWithInput, AsksForAStopAtTheEndOfTheInputAndNotBefore) {
  PipedInput input;
  input.Write();
  { const StopWithInput ends_without_waiting_for_input; }
  const StopWithInput watch;
  input.Write();
  EXPECT_FALSE(StopRequested());
  input.End();
  EXPECT_TRUE(WaitUntil([] { return StopRequested(); }));
}

}  // namespace
}  // namespace shoal
