// SPDX-License-Identifier: Apache-2.0
#include "common/base/liveness_timer.h"

#include <gtest/gtest.h>

namespace shoal {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const SteadyTime kStart = SteadyTime() + seconds(1000);

TEST(LivenessTimer, GrowsWhileNothingIsHeard) {
  LivenessTimer liveness(kStart);
  for (int i = 1; i <= 50; ++i) {
    EXPECT_EQ(liveness.Look(kStart + milliseconds(100 * i)), milliseconds(100 * i));
  }
  liveness.Heard(kStart + seconds(6));
  EXPECT_EQ(liveness.Look(kStart + milliseconds(6500)), milliseconds(500));
}

TEST(LivenessTimer, OwnAbsenceCountsLittle) {
  LivenessTimer liveness(kStart);
  EXPECT_EQ(liveness.Look(kStart + seconds(1)), seconds(1));
  EXPECT_EQ(liveness.Look(kStart + seconds(3600)), seconds(2)) << "stopped for an hour";
  EXPECT_EQ(liveness.Look(kStart + milliseconds(3'600'500)), milliseconds(2500));
}

TEST(LivenessTimer, ALateWordOfAnotherThreadDoesNotCountBackwards) {
  LivenessTimer liveness(kStart);
  liveness.Heard(kStart + seconds(5));
  EXPECT_EQ(liveness.Look(kStart + seconds(4)), seconds(0));
}

}  // namespace
}  // namespace shoal
