// SPDX-License-Identifier: Apache-2.0
#include "common/config/learner_threads.h"

#include <gmock/gmock.h>

#include "common/base/error.h"

namespace shoal {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

Config Of(int threads, int batch, int copies = 1) {
  Config config;
  config.learner.threads = threads;
  config.learner.batch = batch;
  config.replay.copies = copies;
  config.replay.samples_per_insert = Schedule::Constant(8);
  return config;
}

TEST(LearnerThreads, AreThoseAskedForWhateverTheCores) {
  EXPECT_EQ(LearnerThreads(Of(3, 128), 2), 3);
}

TEST(LearnerThreads, AreHalfTheCoresAsFarAsEachHasSixteenRows) {
  EXPECT_EQ(LearnerThreads(Of(0, 128), 1), 1);
  EXPECT_EQ(LearnerThreads(Of(0, 128), 5), 2);
  EXPECT_EQ(LearnerThreads(Of(0, 128), 6), 3) << "of 42 and 43 rows";
  EXPECT_EQ(LearnerThreads(Of(0, 128), 8), 4);
  EXPECT_EQ(LearnerThreads(Of(0, 128), 64), 8) << "of 16 rows each";
  EXPECT_EQ(LearnerThreads(Of(0, 96, /*copies=*/32), 12), 3) << "three transitions with copies";
  EXPECT_EQ(LearnerThreads(Of(0, 8), 64), 1);
}

TEST(LearnerThreads, AreOnAllCoresWithAnUpdateForEachStep) {
  Config config = Of(0, 128);
  config.replay.samples_per_insert = Schedule::Constant(128);
  EXPECT_EQ(LearnerThreads(config, 1), 1);
  EXPECT_EQ(LearnerThreads(config, 2), 2);
  EXPECT_EQ(LearnerThreads(config, 8), 8);
  EXPECT_EQ(LearnerThreads(config, 64), 8) << "of 16 rows each";
}

TEST(LearnerThreads, LeaveAQuarterOfTheCoresWithAnUpdateForEachEighthStep) {
  Config config = Of(0, 96);
  config.replay.samples_per_insert = Schedule::Constant(11);
  EXPECT_EQ(LearnerThreads(config, 2), 1);
  EXPECT_EQ(LearnerThreads(config, 8), 4);
  config.replay.samples_per_insert = Schedule::Constant(12);
  EXPECT_EQ(LearnerThreads(config, 1), 1);
  EXPECT_EQ(LearnerThreads(config, 2), 2) << "rounded up";
  EXPECT_EQ(LearnerThreads(config, 4), 3);
  EXPECT_EQ(LearnerThreads(config, 8), 6);
}

TEST(LearnerThreads, OfAScheduleGoByItsMeanOverTheBudget) {
  Config config = Of(0, 96);
  config.replay.samples_per_insert = Schedule{24, 4, 1000};
  config.env_steps = 1000;  // 14 in the mean: an update for each seventh step
  EXPECT_EQ(LearnerThreads(config, 8), 6);
  config.env_steps = 4000;  // 6.5
  EXPECT_EQ(LearnerThreads(config, 8), 4);
}

TEST(LearnerThreads, IsOneWithoutPixelsUnlessUpdatesAreOfSequences) {
  Config config = Of(0, 128);
  config.observation.pixels = false;
  EXPECT_EQ(LearnerThreads(config, 8), 1);
  config.learner.algorithm = "mrq";
  EXPECT_EQ(LearnerThreads(config, 8), 4);
}

TEST(LearnerThreads, OfAnOnPolicyRunAreHalfTheCores) {
  Config config = Of(0, 64);
  config.learner.algorithm = "ppo";
  EXPECT_EQ(LearnerThreads(config, 6), 3);
}

TEST(CheckReplicas, RefusesMoreThanThereAreTransitions) {
  EXPECT_NO_THROW(CheckReplicas(Of(0, 128), 12));
  EXPECT_NO_THROW(CheckReplicas(Of(0, 6, 2), 3));
  EXPECT_THAT([] { CheckReplicas(Of(0, 4, 2), 3); },
              ThrowsMessage<Error>(AllOf(HasSubstr("learner.threads = 3"), HasSubstr("at most"),
                                         HasSubstr("4 / 2 = 2"))))
      << "a transition's copies stay together";
}

}  // namespace
}  // namespace shoal
