// SPDX-License-Identifier: Apache-2.0
#include "launch/run/train_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/files.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(ResolveConfig, AppliesPresetThenFileThenSet) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "mine.json";
  WriteFileAtomically(file, R"({"seed": 5, "learner": {"batch": 64, "tau": 0.02}})");
  TrainOptions options;
  options.preset = "fetch-reach-state";
  options.config_file = file;
  options.set = {"learner.batch=32"};
  const Config config = ResolveConfig(options, 4);
  EXPECT_FALSE(config.observation.pixels) << "of the preset";
  EXPECT_EQ(config.seed, 5);
  EXPECT_EQ(config.learner.tau, 0.02);
  EXPECT_EQ(config.learner.batch, 32);
}

TEST(ResolveConfig, FillsActorsAndThreadsForTheCores) {
  EXPECT_EQ(ResolveConfig({}, 8).actors, 2);
  EXPECT_EQ(ResolveConfig({}, 8).learner.threads, 6);
  EXPECT_EQ(ResolveConfig({}, 1).actors, 1);
  TrainOptions lockstep;
  lockstep.lockstep = true;
  EXPECT_EQ(ResolveConfig(lockstep, 8).actors, 1);
  EXPECT_TRUE(ResolveConfig(lockstep, 8).lockstep);
  TrainOptions set;
  set.set = {"actors=3", "learner.threads=2"};
  EXPECT_EQ(ResolveConfig(set, 8).actors, 3);
  EXPECT_EQ(ResolveConfig(set, 8).learner.threads, 2);
}

TEST(ResolveConfig, TakesThePresetAFileNames) {
  const TemporaryFolder folder;
  TrainOptions options;
  options.config_file = folder.path() / "mine.json";
  WriteFileAtomically(options.config_file, R"({"preset": "fetch-reach-state"})");
  EXPECT_EQ(ResolveConfig(options, 2).preset, "fetch-reach-state");
  EXPECT_FALSE(ResolveConfig(options, 2).observation.pixels);
  options.preset = "fetch-reach-drq";
  EXPECT_THAT(UsageMessage([&] { ResolveConfig(options, 2); }),
              AllOf(HasSubstr("fetch-reach-drq"), HasSubstr("fetch-reach-state")));
}

TEST(ResolveConfig, RefusesAPresetBySet) {
  TrainOptions options;
  options.set = {"preset=fetch-reach-state"};
  EXPECT_THAT(UsageMessage([&] { ResolveConfig(options, 2); }), HasSubstr("--preset"));
}

TEST(ResolveConfig, RunDirIsTheKeyOfThatName) {
  TrainOptions options;
  options.set = {"run_dir=elsewhere"};
  EXPECT_EQ(ResolveConfig(options, 2).run_dir, "elsewhere");
  options.run_dir = "/there";
  EXPECT_EQ(ResolveConfig(options, 2).run_dir, "/there");
}

TEST(ResolveConfig, RefusesARunNameThatIsNoFileName) {
  TrainOptions options;
  options.run_name = "a/b";
  EXPECT_THAT(UsageMessage([&] { ResolveConfig(options, 2); }), HasSubstr("run_name"));
}

TEST(ApplyResumeOptions, TakesOnlyHowLongToGoOn) {
  Config config;
  TrainOptions options;
  options.set = {"env_steps=7", "stop.success=2"};
  config.learner.threads = 3;
  ApplyResumeOptions(options, /*cores=*/2, &config);
  EXPECT_EQ(config.env_steps, 7);
  EXPECT_EQ(config.learner.threads, 3);
  EXPECT_EQ(config.stop.success, 2);
  options.set = {"learner.precision=f32"};  // for a machine that lacks the other
  ApplyResumeOptions(options, /*cores=*/2, &config);
  EXPECT_EQ(config.learner.precision, "f32");
  options.set = {"learner.threads=2"};  // for a machine that has fewer
  ApplyResumeOptions(options, /*cores=*/2, &config);
  EXPECT_EQ(config.learner.threads, 2);
  options.set = {"learner.threads=0"};
  ApplyResumeOptions(options, /*cores=*/8, &config);
  EXPECT_EQ(config.learner.threads, 6);
  options.set = {"learner.batch=7"};
  EXPECT_THAT(UsageMessage([&] { ApplyResumeOptions(options, 2, &config); }),
              HasSubstr("learner.batch=7"));
  options.set = {};
  options.preset = "fetch-reach-drq";
  EXPECT_THAT(UsageMessage([&] { ApplyResumeOptions(options, 2, &config); }),
              HasSubstr("--preset"));
}

}  // namespace
}  // namespace shoal::launch
