// SPDX-License-Identifier: Apache-2.0
// Short trainings of the real programs with the encoders of torchvision, and from weights of a
// file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/nn/safetensors.h"
#include "tests/support/training_run.h"

namespace shoal {
namespace {

struct EncoderKind {
  const char *encoder, *algorithm;
  const char* side;  // of a frame
};

TrainingRun::Keys KeysOf(const EncoderKind& kind) {
  return TrainingRun::FromPixels({{"network.encoder", kind.encoder},
                                  {"learner.algorithm", kind.algorithm},
                                  {"env_steps", "170"},
                                  {"learner.batch", "4"},
                                  {"learner.checkpoint_period", "50"},
                                  {"observation.cameras", R"(["front"])"},
                                  {"observation.grey", "true"},
                                  {"observation.height", kind.side},
                                  {"observation.width", kind.side},
                                  {"observation.stack", "4"}});
}

class EncoderTraining : public testing::TestWithParam<EncoderKind> {};

TEST_P(EncoderTraining, UpdatesCheckpointsEvaluatesAndStartsAnother) {
  const EncoderKind& kind = GetParam();
  const TrainingRun run;
  const ProgramResult result = run.Train(KeysOf(kind));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  const auto meta = run.Json("meta.json");
  ExpectBalanced(meta);
  EXPECT_GT(meta.at("updates").get<int64_t>(), 50);
  EXPECT_EQ(run.Json("eval/final.json").at("aggregate").at("episodes"), 2);

  // Another run starts from its encoder, including statistics: the average in the first checkpoint
  // has hardly changed.
  const std::filesystem::path policy = run.path() / "checkpoints/best/policy.safetensors";
  TrainingRun::Keys keys = KeysOf(kind);
  keys["network.encoder_weights"] = policy.string();
  keys["learner.learning_rate"] = "1e-9";
  const TrainingRun next;
  const ProgramResult second = next.Train(keys);
  ASSERT_EQ(ExitCode(second), 0) << second.out << second.err;
  EXPECT_THAT(ReadFile(next.path() / "logs/learner-0.log"),
              testing::HasSubstr("the encoder starts from " + policy.string()));
  const auto from = nn::ReadSafetensors(ReadFile(policy), "first");
  const auto to =
      nn::ReadSafetensors(ReadFile(next.path() / "checkpoints/best/policy.safetensors"), "second");
  int compared = 0;
  for (const auto& [name, tensor] : from) {
    if (!name.starts_with("encoder.") || !name.ends_with(".weight")) continue;
    float one, other;
    std::memcpy(&one, tensor.data.data(), sizeof(one));
    std::memcpy(&other, to.at(name).data.data(), sizeof(other));
    EXPECT_NEAR(one, other, 1e-5) << name;
    ++compared;
  }
  EXPECT_GE(compared, 5);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EncoderTraining,
                         testing::Values(EncoderKind{"alexnet", "td3", "84"},
                                         EncoderKind{"resnet18", "ddpg", "36"}),
                         [](const auto& kind) {
                           return std::string(kind.param.encoder) + "_" + kind.param.algorithm;
                         });

}  // namespace
}  // namespace shoal
