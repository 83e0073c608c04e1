// SPDX-License-Identifier: Apache-2.0
#include "launch/run/request_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A small run from state in a folder that is still to be made.
class RequestCheckTest : public testing::Test {
 protected:
  RequestCheckTest() {
    Config& config = request_.config.config;
    config.run_dir = folder_.path() / "runs";
    config.run_name = "a";
    config.observation.pixels = false;
    config.actors = 1;
    config.learner.threads = 1;
    config.replay.capacity = 5000;
    request_.config.spec.blocks = {{"position", 3, true}};
    request_.config.spec.action_size = 2;
  }
  std::string Refusal() {
    return ErrorMessage([this] { CheckRequest(options_, &request_); });
  }

  TemporaryFolder folder_;
  TrainOptions options_;
  RunRequest request_;
};

TEST_F(RequestCheckTest, ARunThatCanStartPassesAndLeavesNothing) {
  EXPECT_EQ(Refusal(), "");
  EXPECT_THAT(request_.initial_weights, IsEmpty());
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "runs"));
}

TEST_F(RequestCheckTest, AReplayLargerThanTheDiskIsRefused) {
  request_.config.config.replay.capacity = int64_t{1} << 50;
  EXPECT_THAT(Refusal(), HasSubstr("replay.capacity"));
}

TEST_F(RequestCheckTest, TwoSourcesOfInitialWeightsAreRefused) {
  request_.config.config.network.encoder_weights = folder_.path() / "absent.safetensors";
  EXPECT_THAT(Refusal(), HasSubstr("absent.safetensors"));
  request_.config.config.network.encoder_weights = "";
  options_.init_from = folder_.path() / "none.safetensors";
  EXPECT_THAT(Refusal(), HasSubstr("none.safetensors"));
}

TEST_F(RequestCheckTest, AResumedRunReadsNoWeightsToStartFrom) {
  request_.config.config.network.encoder_weights = folder_.path() / "absent.safetensors";
  request_.folder = RunFolder::Create(folder_.path() / "runs", "a", /*overwrite=*/false);
  EXPECT_EQ(Refusal(), "") << "its network has them";
}

TEST(CheckOpenFiles, AProcessNeedsThirtyTwo) {
  EXPECT_EQ(ErrorMessage(CheckOpenFiles), "");
  struct rlimit before {};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  const struct rlimit few { 31, before.rlim_max };
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
  EXPECT_THAT(ErrorMessage(CheckOpenFiles), HasSubstr("may open 31 files"));
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
}

TEST(CheckRunCredentials, ASecuredRunNeedsThemAndAnOpenOneDoesNot) {
  EXPECT_EQ(ErrorMessage([] { CheckRunCredentials(""); }), "");
  EXPECT_THAT(ErrorMessage([] { CheckRunCredentials("/absent"); }), HasSubstr("/absent"));
}

}  // namespace
}  // namespace shoal::launch
