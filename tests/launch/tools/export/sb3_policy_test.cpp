// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/sb3_policy.h"

#include <gmock/gmock.h>

#include "tests/launch/tools/export/random_policy.h"
#include "tests/support/error_message.h"

namespace shoal::launch {
namespace {

using nn::ActorOutput;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// A network that Stable-Baselines3 has, too.
policy::CheckpointPolicy Counterpart(const PolicyKind& kind) {
  NetworkConfig network;
  network.layer_norm = false;
  network.log_std = "clamped";
  policy::CheckpointPolicy policy = RandomPolicy(kind, network);
  if (kind.encoder.empty()) return policy;
  for (BlockSpec& block : policy.description.spec.blocks) block.observed = false;
  nn::ParameterSet set(policy.description.Actor().Parameters(), nn::ParameterSet::Use::kInference);
  set.Export(&policy.tensors);  // without columns of a vector
  return policy;
}

std::string ExportRefusal(const policy::CheckpointPolicy& policy) {
  return UsageMessage([&] { WriteSb3(policy); });
}

TEST(Sb3Policy, ParametersHaveTheNamesOfEachAlgorithm) {
  const Sb3File sac = WriteSb3(Counterpart({"", ActorOutput::kGaussian}));
  for (const char* name : {"actor.latent_pi.0.weight", "actor.latent_pi.2.bias", "actor.mu.weight",
                           "actor.log_std.bias"}) {
    EXPECT_THAT(sac.bytes, HasSubstr(name));
  }
  EXPECT_EQ(sac.model,
            "SAC(\"MlpPolicy\", env, policy_kwargs=dict(net_arch=[17, 12], "
            "activation_fn=torch.nn.ReLU))");
  EXPECT_THAT(sac.notes, IsEmpty());
  EXPECT_THAT(WriteSb3(Counterpart({"", ActorOutput::kDeterministic})).bytes,
              AllOf(HasSubstr("actor.mu.0.weight"), HasSubstr("actor.mu.4.weight"),
                    Not(HasSubstr("log_std"))));
  EXPECT_THAT(WriteSb3(Counterpart({"", ActorOutput::kUnsquashed})).bytes,
              AllOf(HasSubstr("mlp_extractor.policy_net.2.weight"), HasSubstr("action_net.weight"),
                    HasSubstr("log_std")));
}

TEST(Sb3Policy, TheNatureEncoderIsTheCnnPolicys) {
  const Sb3File file = WriteSb3(Counterpart({"nature", ActorOutput::kGaussian}));
  for (const char* name :
       {"actor.features_extractor.cnn.0.weight", "actor.features_extractor.cnn.4.bias",
        "actor.features_extractor.linear.0.weight"}) {
    EXPECT_THAT(file.bytes, HasSubstr(name));
  }
  EXPECT_THAT(file.model, AllOf(HasSubstr("CnnPolicy"), HasSubstr("features_dim=512")));
}

TEST(Sb3Policy, WhatTheModelDoesNotTakeIsSaid) {
  policy::CheckpointPolicy policy = Counterpart({"", ActorOutput::kGaussian, true});
  policy.description.network.log_std = "smooth";
  const Sb3File file = WriteSb3(policy);
  ASSERT_EQ(file.notes.size(), 2u);
  EXPECT_THAT(file.notes[0], HasSubstr("network.log_std = smooth"));
  EXPECT_THAT(file.bytes, Not(HasSubstr("actor.log_std")));
  EXPECT_THAT(file.notes[1], HasSubstr("VecNormalize"));
  EXPECT_THAT(file.bytes, HasSubstr("pytorch_variables.pth"));
}

TEST(Sb3Policy, WhatHasNoCounterpartIsRefusedByName) {
  EXPECT_THAT(ExportRefusal(RandomPolicy({""})), HasSubstr("network.layer_norm = true"));
  policy::CheckpointPolicy policy = Counterpart({""});
  policy.description.algorithm = "averaged_ddpg";
  EXPECT_THAT(ExportRefusal(policy), HasSubstr("learner.algorithm = averaged_ddpg"));
  EXPECT_THAT(ExportRefusal(Counterpart({"drq"})), HasSubstr("network.encoder = drq"));
  policy = Counterpart({"nature"});
  for (const std::string trunk : {"tanh", "elu"}) {
    policy.description.network.trunk = trunk;
    EXPECT_THAT(ExportRefusal(policy), HasSubstr("network.trunk = " + trunk));
  }
  policy = Counterpart({""});
  policy.description.network.blocks = 2;
  EXPECT_THAT(ExportRefusal(policy), HasSubstr("network.blocks = 2"));
  policy = Counterpart({"nature"});
  policy.description.spec.blocks[0].observed = true;
  EXPECT_THAT(ExportRefusal(policy), HasSubstr("pixels beside a vector of 4"));
}

}  // namespace
}  // namespace shoal::launch
