// SPDX-License-Identifier: Apache-2.0
// `shoal export` of a real run's checkpoint: other programs read the exported files, and a run
// starts from them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "common/nn/safetensors.h"
#include "tests/support/training_run.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

ProgramResult Export(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"shoal", "export"});
  return RunProgram(std::move(arguments), std::chrono::seconds(120));
}

void ExpectRefusal(const ProgramResult& result, int exit_code, const std::string& word) {
  EXPECT_EQ(ExitCode(result), exit_code) << result.out << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr(word));
}

class ExportTest : public testing::Test {
 protected:
  // One run for all tests of this program.
  static void SetUpTestSuite() {
    run_ = new TrainingRun;
    const ProgramResult result = run_->Train(Keys());
    ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  }
  static void TearDownTestSuite() {
    delete run_;
    run_ = nullptr;
  }
  static TrainingRun::Keys Keys() {
    return TrainingRun::FromPixels({{"env_steps", "240"},
                                    {"learner.batch", "4"},
                                    {"learner.checkpoint_period", "50"},
                                    {"network.layer_norm", "false"},
                                    {"observation.proprioception", "true"},
                                    {"replay.keep", "true"}});
  }
  static fs::path Best() { return run_->path() / "checkpoints/best"; }
  std::string Path(const std::string& name) const { return folder_.path() / name; }

  static TrainingRun* run_;
  const TemporaryFolder folder_;
};

TrainingRun* ExportTest::run_ = nullptr;

TEST_F(ExportTest, ARunsBestCheckpointIsComparedOnWhatItsActorsSaw) {
  const ProgramResult result = Export({run_->path(), "--onnx", Path("policy.onnx")});
  ASSERT_EQ(ExitCode(result), 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("8 random observations: largest difference"),
                                HasSubstr("8 recorded observations: largest difference")));
  EXPECT_GT(fs::file_size(Path("policy.onnx")), 10'000u);
}

TEST_F(ExportTest, ACheckpointLeavesItsRun) {
  fs::copy(Best(), Path("policy"), fs::copy_options::recursive);
  fs::remove(Path("policy") + "/learner.safetensors");
  const ProgramResult result = Export({Path("policy"), "--onnx", Path("policy.onnx")});
  ASSERT_EQ(ExitCode(result), 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("no recorded observations: the checkpoint is in no run"));
}

TEST_F(ExportTest, WhatCannotBeExportedLeavesNothing) {
  const std::string file = Path("policy.onnx");
  ExpectRefusal(Export({Path("absent"), "--onnx", file}), 2, "absent");
  ExpectRefusal(Export({Best()}), 2, "--onnx FILE or --sb3 FILE");
  ExpectRefusal(Export({folder_.path(), "--onnx", file}), 1, "state.json");
  ExpectRefusal(Export({Best(), "--onnx", Path("absent/policy.onnx")}), 1, "absent");
  ExpectRefusal(Export({Best(), "--onnx", file, "--sb3", Path("policy.zip")}), 2,
                "network.encoder = compact has no counterpart");
  fs::copy(Best(), Path("damaged"), fs::copy_options::recursive);
  const fs::path tensors = fs::path(Path("damaged")) / "policy.safetensors";
  std::string bytes = ReadFile(tensors);
  bytes[bytes.size() / 2] ^= 1;
  WriteFileAtomically(tensors, bytes);
  ExpectRefusal(Export({Path("damaged"), "--onnx", file}), 1, "policy.safetensors");
  fs::remove_all(Path("damaged"));
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(ExportTest, APolicyStartsAnotherRun) {
  const std::string policy = Best() / "policy.safetensors";
  TrainingRun::Keys keys = Keys();
  keys["learner.learning_rate"] = "1e-9";
  const TrainingRun next;
  const ProgramResult result = next.Train(keys, {"--init-from", policy});
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  EXPECT_THAT(ReadFile(next.path() / "logs/learner-0.log"), HasSubstr("the networks start from "));
  const auto from = nn::ReadSafetensors(ReadFile(policy), "first");
  const auto to =
      nn::ReadSafetensors(ReadFile(next.path() / "checkpoints/best/policy.safetensors"), "second");
  for (const auto& [name, tensor] : from) {
    float one, other;
    std::memcpy(&one, tensor.data.data(), sizeof(one));
    std::memcpy(&other, to.at(name).data.data(), sizeof(other));
    EXPECT_NEAR(one, other, 1e-5) << name;
  }
}

TEST_F(ExportTest, WeightsThatDoNotFitStartNothing) {
  TrainingRun::Keys keys = Keys();
  keys["network.hidden"] = "[7]";
  const TrainingRun next;
  const ProgramResult result = next.Train(keys, {"--init-from", Best() / "policy.safetensors"});
  ExpectRefusal(result, 2, "tensor actor.mlp.layer");
  EXPECT_FALSE(fs::exists(next.path()));
}

// A script of tests/comparison over checkpoints of every algorithm and encoder, or of those whose
// name has `some`.
void ExpectAgreement(const std::string& script, const std::vector<std::string>& modules,
                     const std::string& some) {
  const char* set = std::getenv("SHOAL_PYTHON");
  const std::string python = set == nullptr ? "/usr/bin/python3" : set;
  for (const std::string& module : modules) {
    if (!fs::exists(python) ||
        ExitCode(RunCommand({python, "-c", "import " + module}, std::chrono::seconds(60))) != 0) {
      GTEST_SKIP() << "needs the Python module " << module;
    }
  }
  const TemporaryFolder folder;
  const ProgramResult made =
      RunProgram({"random-checkpoints", folder.path(), some}, std::chrono::seconds(300));
  ASSERT_EQ(ExitCode(made), 0) << made.err;
  std::vector<std::string> command{python, SourcePath("tests/comparison/" + script),
                                   ProgramPath("shoal")};
  std::istringstream lines(made.out);
  for (std::string line; std::getline(lines, line);) command.push_back(line);
  const ProgramResult result = RunCommand(command, std::chrono::seconds(500));
  EXPECT_EQ(ExitCode(result), 0) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("largest of"));
}

TEST(ExportedPolicy, ActsInOnnxRuntimeAsInShoal) {
  ExpectAgreement("onnx_actions.py", {"onnx", "onnxruntime", "safetensors"}, "");
}

TEST(ExportedPolicy, ActsInStableBaselines3AsInShoal) {
  ExpectAgreement("sb3_policy.py", {"stable_baselines3", "safetensors"}, "-sb3");
}

}  // namespace
}  // namespace shoal
