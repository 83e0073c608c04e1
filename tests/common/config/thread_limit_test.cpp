// SPDX-License-Identifier: Apache-2.0
#include "common/config/thread_limit.h"

#include <gmock/gmock.h>

#include <cmath>

#include "common/base/error.h"

namespace shoal {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(CheckCores, RefusesMoreThreadsThanCoresAndSaysWhatFitsAndWhatLimitsThem) {
  const auto refuse = [](int threads, const CoreLimits& limits) {
    return [=] { CheckCores("learner.threads", threads, limits); };
  };
  EXPECT_NO_THROW(CheckCores("replay.threads", 2, {.online = 2, .affinity = 2, .quota = INFINITY}));
  EXPECT_THAT(refuse(3, {.online = 2, .affinity = 2, .quota = INFINITY}),
              ThrowsMessage<Error>(AllOf(HasSubstr("learner.threads = 3"), HasSubstr("2 cores,"),
                                         HasSubstr("--set learner.threads=N"))));
  EXPECT_THAT(refuse(2, {.online = 2, .affinity = 1, .quota = INFINITY}),
              ThrowsMessage<Error>(HasSubstr("1 core: 1 of 2 by its CPU affinity mask")));
  EXPECT_THAT(refuse(3, {.online = 8, .affinity = 8, .quota = 1.5}),
              ThrowsMessage<Error>(HasSubstr("2 cores: 1.5 by its cgroup's CPU quota")));
  EXPECT_THAT(
      [] { CheckCores("replay.threads", 2, {.online = 1, .affinity = 1, .quota = INFINITY}); },
      ThrowsMessage<Error>(
          AllOf(HasSubstr("replay.threads = 2"), HasSubstr("--set replay.threads=N"))));
}

}  // namespace
}  // namespace shoal
