// SPDX-License-Identifier: Apache-2.0
#include "common/policy/checkpoint_policy.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "common/base/build_info.h"
#include "common/base/crc32.h"
#include "common/base/files.h"
#include "common/config/run_files.h"
#include "common/policy/trained_policy.h"
#include "tests/common/policy/checkpoint_fixture.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::policy {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using testing::AllOf;
using testing::HasSubstr;

uint32_t Crc(const std::string& bytes) {
  return Crc32({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
}

class CheckpointPolicyTest : public testing::Test {
 protected:
  std::string Refusal() const { return Refusal(checkpoint_); }
  static std::string Refusal(const fs::path& folder) {
    std::string message = ErrorMessage([&] { ReadCheckpointPolicy(folder); });
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }

  void Replace(const std::string& file, const std::string& from, const std::string& to) const {
    std::string bytes = ReadFile(checkpoint_ / file);
    ASSERT_NE(bytes.find(from), std::string::npos);
    bytes.replace(bytes.find(from), from.size(), to);
    WriteFileAtomically(checkpoint_ / file, bytes);
  }

  // Changes policy.json, or state.json by the function, and updates the checksums, so that the
  // checkpoint looks like one of another version, not like a damaged one.
  template <class Change>
  void Rewrite(Change change) const {
    ordered_json description = ordered_json::parse(ReadFile(checkpoint_ / kDescriptionFile));
    ordered_json state = ordered_json::parse(ReadFile(checkpoint_ / "state.json"));
    change(&description, &state);
    const std::string text = description.dump(2) + "\n";
    WriteFileAtomically(checkpoint_ / kDescriptionFile, text);
    if (state["files"].contains(kDescriptionFile)) {
      ordered_json& entry = state["files"][kDescriptionFile];
      entry["bytes"] = text.size();
      entry["crc32"] = Crc(text);
    }
    state.erase("crc32");
    state["crc32"] = Crc(state.dump());
    WriteFileAtomically(checkpoint_ / "state.json", state.dump(2) + "\n");
  }
  void ToFormerVersion() const {
    Rewrite([](ordered_json*, ordered_json* state) { (*state)["files"].erase(kDescriptionFile); });
    fs::remove(checkpoint_ / kDescriptionFile);
  }

  const TemporaryFolder folder_;
  const RunConfig run_ = SmallRun("ppo", /*pixels=*/true);
  const fs::path checkpoint_ = WriteCheckpointOf(run_, folder_.path());
};

TEST_F(CheckpointPolicyTest, IsCompleteInItselfWhereverItLies) {
  const TemporaryFolder elsewhere;
  fs::copy(checkpoint_, elsewhere.path() / "policy");
  fs::remove(elsewhere.path() / "policy/learner.safetensors");
  const CheckpointPolicy policy = ReadCheckpointPolicy(elsewhere.path() / "policy");
  EXPECT_EQ(policy.description.spec, run_.spec);
  EXPECT_EQ(policy.description.algorithm, "ppo");
  EXPECT_EQ(policy.description.version, BuildVersion());
  EXPECT_EQ(policy.description.output, nn::ActorOutput::kUnsquashed);
  EXPECT_EQ(policy.description.network.hidden, run_.config.network.hidden);
  EXPECT_EQ(policy.state.updates, 3u);
  EXPECT_TRUE(policy.tensors.contains(nn::kObservationMean));
  EXPECT_TRUE(policy.tensors.contains("actor.log_std"));
}

TEST_F(CheckpointPolicyTest, DoesNotSayWhereTrainingFoundItsEncoder) {
  RunConfig run = run_;
  run.config.network.encoder_weights = "/home/user/encoder.safetensors";
  const std::string text =
      WriteDescription(Describe(run.config, run.spec, nn::ActorOutput::kUnsquashed));
  EXPECT_EQ(text.find("/home/user"), std::string::npos);
}

TEST_F(CheckpointPolicyTest, DamageIsRefusedNamingTheFile) {
  Replace("policy.json", "grip", "grap");
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("policy.json"), HasSubstr("CRC-32"),
                               HasSubstr("take another checkpoint")));
  fs::remove(checkpoint_ / "policy.json");
  EXPECT_THAT(Refusal(), HasSubstr("policy.json"));
}

TEST_F(CheckpointPolicyTest, DamagedParametersAreRefused) {
  fs::resize_file(checkpoint_ / "policy.safetensors", 100);
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("policy.safetensors"), HasSubstr("100 bytes"),
                               HasSubstr("take another checkpoint")));
}

TEST_F(CheckpointPolicyTest, NoCheckpointIsRefusedByName) {
  EXPECT_EQ(Refusal("/nonexistent/step"),
            "'/nonexistent/step': expected a folder with a checkpoint");
  const TemporaryFolder empty;
  EXPECT_THAT(Refusal(empty.path()), HasSubstr("state.json"));
}

TEST_F(CheckpointPolicyTest, ANewerFormatIsRefusedNamingBoth) {
  Rewrite([](ordered_json* description, ordered_json*) {
    (*description)["schema"] = "shoal-policy-2";
  });
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("policy.json"), HasSubstr("\"shoal-policy-2\""),
                               HasSubstr("\"shoal-policy-1\""), HasSubstr("newer")));
}

TEST_F(CheckpointPolicyTest, ANewerCheckpointIsRefusedNamingBoth) {
  Rewrite([](ordered_json*, ordered_json* state) { (*state)["schema"] = "shoal-checkpoint-2"; });
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("state.json"), HasSubstr("shoal-checkpoint-2"),
                               HasSubstr("shoal-checkpoint-1"), HasSubstr("newer")));
}

TEST_F(CheckpointPolicyTest, AKeyOfAnotherVersionIsRefusedNamingItAndTheVersion) {
  Rewrite([](ordered_json* description, ordered_json*) {
    (*description)["version"] = "7.1.0";
    (*description)["network"]["attention"] = 4;
  });
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("network.attention"), HasSubstr("written by Shoal 7.1.0"),
                               HasSubstr("use the version that wrote it")));
}

TEST_F(CheckpointPolicyTest, AnEncoderThatIsNotHereIsRefused) {
  Rewrite([](ordered_json* description, ordered_json*) {
    (*description)["network"]["encoder"] = "strided";
  });
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("network.encoder"), HasSubstr("strided")));
}

TEST_F(CheckpointPolicyTest, ANetworkThatComputesSomethingElseHereIsRefusedNamingTheLayer) {
  Rewrite([](ordered_json* description, ordered_json*) {
    std::string line = (*description)["layers"][0];
    line.replace(line.find("[-0.5, 0.5]"), 11, "[0, 1]");
    (*description)["layers"][0] = line;
  });
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("layers"), HasSubstr("[0, 1]"), HasSubstr("[-0.5, 0.5]")));
}

TEST_F(CheckpointPolicyTest, FilesOfDifferentCheckpointsAreRefused) {
  Rewrite([](ordered_json* description, ordered_json*) { (*description)["algorithm"] = "sac"; });
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("'sac'"), HasSubstr("'ppo'")));
  Rewrite([](ordered_json* description, ordered_json*) {
    (*description)["algorithm"] = "ppo";
    (*description)["output"] = "deterministic";
    std::string line = (*description)["layers"].back();
    line.replace(line.find("unsquashed"), 10, "deterministic");
    (*description)["layers"].back() = line;
  });
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("deterministic"), HasSubstr("unsquashed")));
}

TEST_F(CheckpointPolicyTest, OneOfAFormerVersionIsReadInItsRun) {
  const CheckpointPolicy now = ReadCheckpointPolicy(checkpoint_);
  ToFormerVersion();
  WriteRunConfig(folder_.path(), run_);
  const CheckpointPolicy former = ReadCheckpointPolicy(checkpoint_);
  EXPECT_EQ(former.description.spec, now.description.spec);
  EXPECT_EQ(former.description.output, now.description.output);
  EXPECT_EQ(former.description.network.filters, now.description.network.filters);
  fs::rename(checkpoint_, folder_.path() / "checkpoints/candidates");  // one folder deeper
  fs::create_directories(folder_.path() / "deeper");
  fs::rename(folder_.path() / "checkpoints", folder_.path() / "deeper/checkpoints");
  EXPECT_EQ(ReadCheckpointPolicy(folder_.path() / "deeper/checkpoints/candidates").description.spec,
            run_.spec);
}

TEST_F(CheckpointPolicyTest, OneOfAFormerVersionIsRefusedElsewhere) {
  ToFormerVersion();
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("has no policy.json"), HasSubstr("config.json")));
  RunConfig another = run_;
  another.spec.blocks[0].size = 4;
  WriteRunConfig(folder_.path(), another);
  EXPECT_THAT(Refusal(), HasSubstr("has no policy.json")) << "another run's folder";
}

}  // namespace
}  // namespace shoal::policy
