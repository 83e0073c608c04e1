// SPDX-License-Identifier: Apache-2.0
#include "common/policy/shoal_policy.h"

#include <gmock/gmock.h>

#include <limits>
#include <string>
#include <thread>

#include "common/base/build_info.h"
#include "common/policy/trained_policy.h"
#include "tests/common/policy/checkpoint_fixture.h"
#include "tests/support/temporary_folder.h"

namespace shoal::policy {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

// A policy of the C library and what it observes.
class ShoalPolicyTest : public testing::Test {
 protected:
  ShoalPolicyTest() {
    EXPECT_EQ(shoal_policy_load(checkpoint_.c_str(), &policy_), SHOAL_POLICY_OK)
        << shoal_policy_error();
    for (const auto& [name, values] : random_.blocks) {
      blocks_.push_back({name.c_str(), values.data(), values.size()});
    }
    seen_ = {2, random_.pixels.data(), random_.pixels.size(), blocks_.data(), blocks_.size()};
  }
  ~ShoalPolicyTest() override { shoal_policy_free(policy_); }

  shoal_policy_status Act() {
    return shoal_policy_act(policy_, &seen_, actions_.data(), actions_.size());
  }

  const TemporaryFolder folder_;
  const RunConfig run_ = SmallRun("td3", /*pixels=*/true);
  const std::filesystem::path checkpoint_ = WriteCheckpointOf(run_, folder_.path());
  const RandomObservations random_{run_.spec, 2, 8};
  shoal_policy* policy_ = nullptr;
  std::vector<shoal_policy_block> blocks_;
  shoal_policy_observations seen_ = {};
  std::vector<float> actions_ = std::vector<float>(4);
};

TEST_F(ShoalPolicyTest, SaysWhatThePolicyObserves) {
  EXPECT_STREQ(shoal_policy_version(), BuildVersion());
  EXPECT_STREQ(shoal_policy_task(policy_), "test");
  EXPECT_STREQ(shoal_policy_algorithm(policy_), "td3");
  EXPECT_EQ(shoal_policy_action_size(policy_), 2u);
  const auto [stack, channels, height, width] = shoal_policy_pixels(policy_);
  EXPECT_THAT((std::vector{stack, channels, height, width}), ElementsAre(2, 1, 18, 16));
  EXPECT_EQ(shoal_policy_camera_count(policy_), 1u);
  EXPECT_STREQ(shoal_policy_camera_name(policy_, 0), "front");
  EXPECT_EQ(shoal_policy_camera_name(policy_, 1), nullptr);
  ASSERT_EQ(shoal_policy_block_count(policy_), 2u) << "the hidden one is not observed";
  EXPECT_STREQ(shoal_policy_block_name(policy_, 0), "grip");
  EXPECT_STREQ(shoal_policy_block_name(policy_, 1), "goal");
  EXPECT_EQ(shoal_policy_block_size(policy_, 0), 3u);
  EXPECT_EQ(shoal_policy_block_size(policy_, 1), 2u);
  EXPECT_EQ(shoal_policy_block_name(policy_, 2), nullptr);
  EXPECT_EQ(shoal_policy_block_size(policy_, 2), 0u);
}

TEST_F(ShoalPolicyTest, APolicyOfStateAloneHasNoPixels) {
  const TemporaryFolder folder;
  const auto checkpoint = WriteCheckpointOf(SmallRun("sac", /*pixels=*/false), folder.path());
  shoal_policy* policy = nullptr;
  ASSERT_EQ(shoal_policy_load(checkpoint.c_str(), &policy), SHOAL_POLICY_OK);
  const auto [stack, channels, height, width] = shoal_policy_pixels(policy);
  EXPECT_THAT((std::vector{stack, channels, height, width}), ElementsAre(0, 0, 0, 0));
  EXPECT_EQ(shoal_policy_camera_count(policy), 0u);
  seen_.pixels = nullptr;
  seen_.pixel_count = 0;
  EXPECT_EQ(shoal_policy_act(policy, &seen_, actions_.data(), 4), SHOAL_POLICY_OK)
      << shoal_policy_error();
  shoal_policy_free(policy);
}

TEST_F(ShoalPolicyTest, ActsAsTheLoaderDoes) {
  ASSERT_EQ(Act(), SHOAL_POLICY_OK) << shoal_policy_error();
  TrainedPolicy trained(checkpoint_);
  std::vector<ObservedBlock> blocks;
  for (const auto& [name, values] : random_.blocks) blocks.push_back({name, values});
  std::vector<float> expected(4);
  trained.Act({2, random_.pixels, blocks}, expected);
  EXPECT_EQ(actions_, expected);
}

TEST_F(ShoalPolicyTest, PoliciesOfSeveralThreadsAreIndependent) {
  ASSERT_EQ(Act(), SHOAL_POLICY_OK);
  std::vector<std::thread> threads;
  std::vector<std::vector<float>> all(3, std::vector<float>(4));
  for (std::vector<float>& actions : all) {
    threads.emplace_back([&] {
      shoal_policy* own = nullptr;
      ASSERT_EQ(shoal_policy_load(checkpoint_.c_str(), &own), SHOAL_POLICY_OK);
      for (int i = 0; i < 20; ++i) shoal_policy_act(own, &seen_, actions.data(), actions.size());
      shoal_policy_free(own);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::vector<float>& actions : all) EXPECT_EQ(actions, actions_);
}

TEST_F(ShoalPolicyTest, ACheckpointThatCannotBeUsedIsRefusedInOneLine) {
  shoal_policy* policy = policy_;
  EXPECT_EQ(shoal_policy_load("/nowhere\n/step", &policy), SHOAL_POLICY_BAD_CHECKPOINT);
  EXPECT_EQ(policy, nullptr);
  EXPECT_STREQ(shoal_policy_error(), "'/nowhere /step': expected a folder with a checkpoint");
  std::filesystem::resize_file(checkpoint_ / "policy.safetensors", 9);
  EXPECT_EQ(shoal_policy_load(checkpoint_.c_str(), &policy), SHOAL_POLICY_BAD_CHECKPOINT);
  EXPECT_THAT(shoal_policy_error(), AllOf(HasSubstr("policy.safetensors"), HasSubstr("9 bytes")));
}

TEST_F(ShoalPolicyTest, WhatDoesNotFitIsRefusedByName) {
  const auto refusal = [&](shoal_policy_status expected) {
    EXPECT_EQ(Act(), expected);
    return std::string(shoal_policy_error());
  };
  seen_.block_count = 1;
  EXPECT_THAT(refusal(SHOAL_POLICY_BAD_ARGUMENT), HasSubstr("block 'goal' is missing"));
  seen_.block_count = 2;
  blocks_[1].count = 5;
  EXPECT_THAT(refusal(SHOAL_POLICY_BAD_ARGUMENT), HasSubstr("block 'goal': 5 numbers, expected 4"));
  blocks_[1].count = 4;
  blocks_[0].name = "grap";
  EXPECT_THAT(refusal(SHOAL_POLICY_BAD_ARGUMENT), HasSubstr("block 'grap' is not observed"));
  blocks_[0].name = "grip";
  seen_.pixel_count -= 1;
  EXPECT_THAT(refusal(SHOAL_POLICY_BAD_ARGUMENT), HasSubstr("pixels: 1151 bytes, expected 1152"));
  seen_.pixel_count += 1;
  seen_.count = 0;
  EXPECT_THAT(refusal(SHOAL_POLICY_BAD_ARGUMENT), HasSubstr("0 observations"));
  seen_.count = size_t{1} << 40;
  EXPECT_THAT(refusal(SHOAL_POLICY_BAD_ARGUMENT), HasSubstr("observations, expected at most"));
  seen_.count = 2;
  const std::vector<float> infinite(6, std::numeric_limits<float>::infinity());
  blocks_[0].values = infinite.data();
  EXPECT_THAT(refusal(SHOAL_POLICY_NOT_FINITE), HasSubstr("block 'grip'"));
}

TEST_F(ShoalPolicyTest, NullIsRefusedByName) {
  const auto refusal = [&](shoal_policy* policy, const shoal_policy_observations* seen,
                           float* actions) {
    EXPECT_EQ(shoal_policy_act(policy, seen, actions, 4), SHOAL_POLICY_BAD_ARGUMENT);
    return std::string(shoal_policy_error());
  };
  EXPECT_EQ(refusal(nullptr, &seen_, actions_.data()), "policy is NULL");
  EXPECT_EQ(refusal(policy_, nullptr, actions_.data()), "observations is NULL");
  EXPECT_EQ(refusal(policy_, &seen_, nullptr), "actions is NULL");
  shoal_policy_observations seen = seen_;
  seen.pixels = nullptr;
  EXPECT_EQ(refusal(policy_, &seen, actions_.data()), "observations->pixels is NULL");
  seen = seen_;
  seen.blocks = nullptr;
  EXPECT_EQ(refusal(policy_, &seen, actions_.data()), "observations->blocks is NULL");
  blocks_[0].values = nullptr;
  EXPECT_EQ(refusal(policy_, &seen_, actions_.data()), "block 'grip': its values are NULL");
  blocks_[0].name = nullptr;
  EXPECT_EQ(refusal(policy_, &seen_, actions_.data()), "the name of block 0 is NULL");
  shoal_policy* none = nullptr;
  EXPECT_EQ(shoal_policy_load(nullptr, &none), SHOAL_POLICY_BAD_ARGUMENT);
  EXPECT_STREQ(shoal_policy_error(), "checkpoint is NULL");
  EXPECT_EQ(shoal_policy_load(checkpoint_.c_str(), nullptr), SHOAL_POLICY_BAD_ARGUMENT);
  EXPECT_STREQ(shoal_policy_error(), "policy is NULL");
  shoal_policy_free(nullptr);
}

}  // namespace
}  // namespace shoal::policy
