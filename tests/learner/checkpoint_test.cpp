// SPDX-License-Identifier: Apache-2.0
#include "learner/checkpoint.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/learner/training_fixture.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::learner {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kSpecHash = 0xfeedfacecafebeef;

nn::TensorMap Tensors(const std::string& name, size_t bytes, uint8_t first) {
  nn::NamedTensor tensor{"F32", {static_cast<int64_t>(bytes / 4)}, {}};
  for (size_t i = 0; i < bytes; ++i) tensor.data.push_back(static_cast<uint8_t>(first + 7 * i));
  return {{name, tensor}};
}

// Files smaller than `bytes` only, as on a full disk, while it lives.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_;
};

class CheckpointTest : public testing::Test {
 protected:
  void Write(uint8_t first = 1) {
    WriteCheckpoint(parent_.path(), state_, Tensors("critic", 4000, first),
                    Tensors("actor", 400, first), SmallRun(),
                    {{"schema", "shoal-checkpoint-meta-1"}});
  }

  // The message of the Error with which the checkpoint is refused.
  std::string Refusal(uint64_t spec = kSpecHash) {
    return ErrorMessage([&] { ReadCheckpoint(folder_, spec); });
  }

  void Overwrite(const fs::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
  }

  size_t EntriesOfParent() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(parent_.path()), {}));
  }

  const TemporaryFolder parent_;
  const CheckpointState state_{.updates = 2000,
                               .env_steps = 4321,
                               .request = 2001,
                               .learner_session = 1'700'000'000'123'456'789,
                               .config_hash = 0xffffffffffffffff,
                               .spec_hash = kSpecHash,
                               .precision = "bf16",
                               .algorithm = "td3"};
  const fs::path folder_ = parent_.path() / "step_000002000";
};

TEST_F(CheckpointTest, ReadsBackWhatWasWritten) {
  Write();
  const Checkpoint checkpoint = ReadCheckpoint(folder_, kSpecHash);
  EXPECT_EQ(checkpoint.state, state_);
  EXPECT_EQ(checkpoint.folder, folder_);
  EXPECT_EQ(checkpoint.description, ReadFile(folder_ / "policy.json"));
  ASSERT_TRUE(checkpoint.tensors.contains("critic"));
  EXPECT_EQ(checkpoint.tensors.at("critic").data, Tensors("critic", 4000, 1)["critic"].data);
  EXPECT_EQ(EntriesOfParent(), 1u) << "no temporary folder stays";
}

TEST_F(CheckpointTest, HoldsTheFilesThatOthersRead) {
  Write();
  const auto policy = nn::ReadSafetensors(ReadFile(folder_ / "policy.safetensors"), "policy");
  EXPECT_EQ(policy.at("actor").data.size(), 400u);
  const auto state = nlohmann::json::parse(ReadFile(folder_ / "state.json"));
  EXPECT_EQ(state.at("schema"), "shoal-checkpoint-1");
  EXPECT_EQ(state.at("updates"), 2000);
  EXPECT_EQ(state.at("env_steps"), 4321);
  EXPECT_EQ(state.at("session"), 1'700'000'000'123'456'789);
  EXPECT_EQ(state.at("config_hash"), "ffffffffffffffff");
  EXPECT_EQ(nlohmann::json::parse(ReadFile(folder_ / ".meta.json")).at("schema"),
            "shoal-checkpoint-meta-1");
}

TEST_F(CheckpointTest, TakesThePlaceOfOneOfTheSameName) {
  Write(1);
  Write(9);
  EXPECT_EQ(ReadCheckpoint(folder_, kSpecHash).tensors.at("critic").data[0], 9);
  EXPECT_EQ(EntriesOfParent(), 1u);
}

TEST_F(CheckpointTest, TruncationOfAnyFileIsRefusedNamingIt) {
  for (const char* name :
       {"learner.safetensors", "policy.safetensors", "policy.json", "state.json"}) {
    Write();
    const std::string whole = ReadFile(folder_ / name);
    for (const size_t bytes : {size_t{0}, size_t{1}, whole.size() / 2, whole.size() - 2}) {
      Overwrite(folder_ / name, whole.substr(0, bytes));
      EXPECT_NE(Refusal().find(name), std::string::npos) << name << " of " << bytes << " bytes";
    }
    fs::remove(folder_ / name);
    EXPECT_NE(Refusal().find(name), std::string::npos) << name << " missing";
  }
}

TEST_F(CheckpointTest, AnyFlippedBitOfTheStateIsRefused) {
  Write();
  const std::string whole = ReadFile(folder_ / "state.json");
  for (size_t byte = 0; byte + 1 < whole.size(); ++byte) {  // the last is a line end
    std::string flipped = whole;
    flipped[byte] = static_cast<char>(flipped[byte] ^ (1 << byte % 8));
    Overwrite(folder_ / "state.json", flipped);
    ASSERT_NE(Refusal().find("state.json"), std::string::npos) << "byte " << byte;
  }
}

TEST_F(CheckpointTest, AFlippedBitOfTheParametersIsRefusedByChecksum) {
  for (const char* name : {"learner.safetensors", "policy.safetensors", "policy.json"}) {
    Write();
    const std::string whole = ReadFile(folder_ / name);
    for (size_t byte = 0; byte < whole.size(); byte += 37) {
      std::string flipped = whole;
      flipped[byte] = static_cast<char>(flipped[byte] ^ 0x10);
      Overwrite(folder_ / name, flipped);
      const std::string refusal = Refusal();
      ASSERT_NE(refusal.find(name), std::string::npos) << "byte " << byte << ": " << refusal;
      ASSERT_NE(refusal.find("CRC-32"), std::string::npos) << refusal;
    }
  }
}

TEST_F(CheckpointTest, AnotherVersionIsRefusedNamingBoth) {
  Write();
  std::string state = ReadFile(folder_ / "state.json");
  state.replace(state.find("shoal-checkpoint-1"), 18, "shoal-checkpoint-2");
  Overwrite(folder_ / "state.json", state);
  EXPECT_NE(Refusal().find("shoal-checkpoint-1"), std::string::npos) << Refusal();
  EXPECT_NE(Refusal().find("shoal-checkpoint-2"), std::string::npos) << Refusal();
}

TEST_F(CheckpointTest, AnotherObservationSpecIsRefusedNamingBoth) {
  Write();
  const std::string refusal = Refusal(/*spec=*/0x1234);
  EXPECT_NE(refusal.find("feedfacecafebeef"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("0000000000001234"), std::string::npos) << refusal;
}

TEST_F(CheckpointTest, AFullDiskLeavesNothingHalfWritten) {
  Write(1);
  std::string message;
  {
    const FileSizeLimit full(1000);  // the policy fits, the learner's state does not
    try {
      Write(9);
    } catch (const Error& e) {
      message = e.what();
    }
  }
  EXPECT_NE(message.find("learner.safetensors"), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_EQ(EntriesOfParent(), 1u);
  EXPECT_EQ(ReadCheckpoint(folder_, kSpecHash).tensors.at("critic").data[0], 1) << "the old one";
}

TEST(CheckPrecision, AnotherOneIsRefusedUnlessAskedFor) {
  Checkpoint checkpoint;
  checkpoint.folder = "checkpoints/step_000002000";
  checkpoint.state.precision = "bf16";
  EXPECT_EQ(CheckPrecision(checkpoint, "auto", nn::Precision::kBf16), "");
  EXPECT_EQ(CheckPrecision(checkpoint, "bf16", nn::Precision::kBf16), "");
  const std::string warning = CheckPrecision(checkpoint, "f32", nn::Precision::kF32);
  EXPECT_NE(warning.find("step_000002000 was computed in bf16, its continuation uses f32"),
            std::string::npos)
      << warning;
  try {
    CheckPrecision(checkpoint, "auto", nn::Precision::kF32);
    FAIL() << "went on in another precision without a word";
  } catch (const Error& e) {
    EXPECT_EQ(e.exit_code(), 2);
    const std::string message = e.what();
    EXPECT_NE(message.find("was computed in bf16"), std::string::npos) << message;
    EXPECT_NE(message.find("--set learner.precision=f32"), std::string::npos) << message;
  }
}

TEST(CheckpointName, IsPaddedAndParsedStrictly) {
  EXPECT_EQ(CheckpointName(2000), "step_000002000");
  EXPECT_EQ(CheckpointName(12'345'678'901), "step_12345678901");
  EXPECT_EQ(CheckpointUpdates("step_000002000"), 2000u);
  EXPECT_EQ(CheckpointUpdates("step_12345678901"), 12'345'678'901u);
  for (const char* other : {"best", "step_2000", "step_000002000x", "step_",
                            "refused_step_000002000", ".step_000002000.tmp-1", "step_-00002000"}) {
    EXPECT_FALSE(CheckpointUpdates(other)) << other;
  }
}

}  // namespace
}  // namespace shoal::learner
