// SPDX-License-Identifier: Apache-2.0
#include "launch/check/training_probe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

Config Small() {
  Config config;
  config.observation.cameras = {"close"};
  config.observation.height = config.observation.width = 36;
  config.learner.batch = 8;
  config.network.filters = {4, 4};
  config.network.strides = {2, 2};
  config.network.hidden = {16, 16};
  return config;
}

TEST(TrainingProbe, LearnsWritesReadsBackAndGoesOnTheSame) {
  const TemporaryFolder folder;
  const TrainingProbe probe = ProbeTraining(Small(), folder.path(), /*updates=*/3);
  EXPECT_EQ(probe.updates, 3u);
  EXPECT_GE(probe.env_steps, 100u);
  EXPECT_TRUE(probe.finite);
  EXPECT_TRUE(probe.moved);
  EXPECT_TRUE(probe.restored);
  EXPECT_TRUE(probe.continued);
  EXPECT_GT(probe.checkpoint_bytes, 1000u);
  EXPECT_EQ(JudgeTraining(probe).verdict, Verdict::kOk);
}

TEST(TrainingProbe, NoUpdatesMoveNothing) {
  const TemporaryFolder folder;
  const TrainingProbe probe = ProbeTraining(Small(), folder.path(), /*updates=*/0);
  EXPECT_FALSE(probe.moved);
  EXPECT_EQ(JudgeTraining(probe).verdict, Verdict::kFail);
}

TEST(TrainingProbe, AFolderThatCannotBeUsedIsAnErrorThatNamesIt) {
  const TemporaryFolder folder;
  WriteFileAtomically(folder.path() / "file", "no folder");
  try {
    ProbeTraining(Small(), folder.path() / "file", /*updates=*/1);
    FAIL() << "wrote into a file";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr((folder.path() / "file").string()));
  }
}

TEST(TrainingProbe, EveryFaultFailsTheLineByName) {
  TrainingProbe good;
  good.finite = good.moved = good.restored = good.continued = true;
  EXPECT_EQ(JudgeTraining(good).verdict, Verdict::kOk);
  const auto finding = [&](bool TrainingProbe::*fault) {
    TrainingProbe probe = good;
    probe.*fault = false;
    EXPECT_EQ(JudgeTraining(probe).verdict, Verdict::kFail);
    return JudgeTraining(probe).finding;
  };
  EXPECT_THAT(finding(&TrainingProbe::finite), testing::HasSubstr("not finite"));
  EXPECT_THAT(finding(&TrainingProbe::moved), testing::HasSubstr("parameters"));
  EXPECT_THAT(finding(&TrainingProbe::restored), testing::HasSubstr("checkpoint"));
  EXPECT_THAT(finding(&TrainingProbe::continued), testing::HasSubstr("computes different updates"));
}

}  // namespace
}  // namespace shoal::launch
