// SPDX-License-Identifier: Apache-2.0
#include "common/policy/checkpoint_writer.h"

#include <gmock/gmock.h>

#include "common/base/files.h"
#include "common/policy/policy_description.h"
#include "tests/common/policy/checkpoint_fixture.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::policy {
namespace {

TEST(NetworkDifference, NamesEachKeyWithBothValues) {
  NetworkConfig there, here;
  EXPECT_EQ(NetworkDifference(there, here), "");
  here.encoder_weights = "elsewhere.safetensors";
  EXPECT_EQ(NetworkDifference(there, here), "");
  here.encoder = "drq";
  here.hidden = {64};
  EXPECT_EQ(NetworkDifference(there, here),
            "network.encoder = \"compact\" there, \"drq\" here; network.hidden = [256,256] there, "
            "[64] here");
}

class CheckpointWriterTest : public testing::Test {
 protected:
  std::string Refusal(const Config& config, const std::string& description) const {
    return UsageMessage(
        [&] { CheckWriter("runs/a/checkpoints/best", state_, description, config); });
  }

  const RunConfig run_ = SmallRun("td3", /*pixels=*/true);
  const CheckpointState state_{.precision = "f32", .algorithm = "td3"};
  const std::string text_ =
      WriteDescription(Describe(run_.config, run_.spec, nn::ActorOutput::kDeterministic));
};

TEST_F(CheckpointWriterTest, TheRunsOwnIsTaken) {
  EXPECT_EQ(Refusal(run_.config, text_), "");
  EXPECT_EQ(Refusal(run_.config, ""), "");
}

TEST_F(CheckpointWriterTest, AnotherAlgorithmIsRefusedNamingBoth) {
  Config config = run_.config;
  config.learner.algorithm = "sac";
  EXPECT_EQ(Refusal(config, text_),
            "'runs/a/checkpoints/best' was written by learner.algorithm = \"td3\", the run is "
            "configured with \"sac\": expected the same, or a new run");
}

TEST_F(CheckpointWriterTest, AnotherNetworkIsRefusedNamingBoth) {
  Config config = run_.config;
  config.network.hidden = {3};
  EXPECT_EQ(Refusal(config, text_),
            "'runs/a/checkpoints/best' is of another network than the run's: " +
                NetworkDifference(run_.config.network, config.network) +
                "; expected the same, or a new run");
  EXPECT_THAT(Refusal(config, text_), testing::HasSubstr("network.hidden = ["));
  EXPECT_EQ(Refusal(config, ""), "") << "of a former version, which says nothing of it";
}

TEST_F(CheckpointWriterTest, TheWriterOfAFileOfWeightsIsKnownByWhatLiesBesideIt) {
  const TemporaryFolder folder;
  const auto weights = folder.path() / kPolicyFile;
  NetworkConfig here = run_.config.network;
  here.features = 5;
  EXPECT_EQ(DifferenceFromWriter(weights, here), "");
  WriteFileAtomically(folder.path() / kDescriptionFile, text_);
  EXPECT_EQ(DifferenceFromWriter(weights, run_.config.network), "");
  EXPECT_EQ(DifferenceFromWriter(weights, here), NetworkDifference(run_.config.network, here));
  EXPECT_THAT(DifferenceFromWriter(weights, here), testing::HasSubstr("network.features = "));
  WriteFileAtomically(folder.path() / kDescriptionFile, "{}");
  EXPECT_EQ(DifferenceFromWriter(weights, here), "");
}

}  // namespace
}  // namespace shoal::policy
