// SPDX-License-Identifier: Apache-2.0
#include "actor/acting/fault_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/error_message.h"

namespace shoal::actor {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using worlds::EpisodeFault;
using worlds::FaultCause;

const EpisodeFault kFault(FaultCause::kObservation, "task T: y of block 'position' is nan");

TEST(FaultLog, CountsByCause) {
  FaultLog log(1);
  log.Count(kFault);
  log.Count(kFault);
  log.Count({FaultCause::kReward, "r"});
  EXPECT_EQ(log.count(FaultCause::kObservation), 2u);
  EXPECT_EQ(log.count(FaultCause::kReward), 1u);
  EXPECT_EQ(log.count(FaultCause::kDiverged), 0u);
  EXPECT_EQ(log.total(), 3u);
}

TEST(FaultLog, OneInTwentyIsAnException) {
  FaultLog log(0.05);
  for (int i = 0; i < 10'000; ++i) {
    if (i % 20 == 0) {
      ASSERT_NO_THROW(log.Count(kFault)) << i;
    } else {
      log.Ended();
    }
  }
}

TEST(FaultLog, OneInNineteenIsNone) {
  FaultLog log(0.05);
  const std::string line = ErrorMessage(3, [&] {
    for (int i = 0; i < 10'000; ++i) {
      if (i % 19 == 0) {
        log.Count(kFault);
      } else {
        log.Ended();
      }
    }
  });
  EXPECT_THAT(line, AllOf(HasSubstr("y of block 'position' is nan; 11 of the last 191 episodes"),
                          HasSubstr("max_faulty_share = 0.05")));
}

TEST(FaultLog, ATaskOfFaultsEndsWithinAFewEpisodes) {
  FaultLog log(0.05);
  for (int i = 0; i < 10; ++i) log.Count(kFault);
  EXPECT_THAT(ErrorMessage(3, [&] { log.Count(kFault); }), HasSubstr("11 of the last 11 episodes"));
}

TEST(FaultLog, FaultsThatAreLongPastAreForgiven) {
  FaultLog log(0.05);
  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i < 10; ++i) ASSERT_NO_THROW(log.Count(kFault));
    for (size_t i = 0; i < FaultLog::kWindow; ++i) log.Ended();
  }
}

TEST(FaultLog, WithAShareOfZeroTheFirstOneEndsIt) {
  FaultLog log(0);
  for (int i = 0; i < 1000; ++i) log.Ended();
  EXPECT_EQ(ErrorMessage(3, [&] { log.Count(kFault); }), kFault.what());
}

TEST(FaultLog, WithAShareOfOneNoneDoes) {
  FaultLog log(1);
  for (int i = 0; i < 1000; ++i) ASSERT_NO_THROW(log.Count(kFault));
}

TEST(FaultLog, LogsAtMostOneLineInTenSeconds) {
  SteadyTime now{};
  FaultLog log(1, [&] { return now; });
  testing::internal::CaptureStderr();
  for (int i = 0; i < 5; ++i) {
    log.Count(kFault);
    now += std::chrono::seconds(1);
  }
  now += std::chrono::seconds(5);  // ten after the first
  log.Count(kFault);
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_THAT(text, AllOf(HasSubstr("(1 faulty episodes so far)"),
                          HasSubstr("(5 since the last such line, 6 faulty episodes so far)")));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2) << text;
}

}  // namespace
}  // namespace shoal::actor
