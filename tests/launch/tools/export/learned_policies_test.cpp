// SPDX-License-Identifier: Apache-2.0
// Export of checkpoints whose networks hold more than a policy: only the policy is exported.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "launch/tools/export/onnx_policy.h"
#include "launch/tools/export/policy_actions.h"
#include "tests/common/policy/checkpoint_fixture.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using testing::ElementsAre;

policy::CheckpointPolicy Learned(const RunConfig& run) {
  const TemporaryFolder folder;
  return policy::ReadCheckpointPolicy(policy::WriteCheckpointOf(run, folder.path()));
}

// Compares the actions of a policy that sees pixels and the blocks "grip" and "goal", not "hidden".
void ExpectItsActions(const RunConfig& run) {
  const policy::CheckpointPolicy policy = Learned(run);
  const ObservationSpec& spec = policy.description.spec;
  const OnnxModel model = ReadOnnx(WriteOnnx(PolicyToOnnx(policy)), "test");
  std::vector<std::string> inputs;
  for (const OnnxPort& port : model.inputs) inputs.push_back(port.name);
  EXPECT_THAT(inputs, ElementsAre("pixels", "grip", "goal"));
  const auto scale = nn::ReadVectorScale(policy.tensors, spec.VectorSize(), "");
  const ObservationSet observations = RandomObservations(spec, scale, 4, /*seed=*/3);
  const Agreement agreement =
      Compare(OwnActions(policy, observations), OnnxActions(model, spec, observations), 4);
  EXPECT_LT(agreement.largest_difference, 2e-5);
  EXPECT_GT(agreement.most - agreement.least, 0.01);  // there is something to tell apart
}

TEST(LearnedPolicies, ACriticThatSeesMoreStaysBehind) {
  RunConfig run = policy::SmallRun("sac", /*pixels=*/true);
  run.config.sac.critic_blocks = true;
  ExpectItsActions(run);
}

TEST(LearnedPolicies, WhatTheEncoderWasTaughtByStaysBehind) {
  RunConfig run = policy::SmallRun("sac", /*pixels=*/true);
  run.config.sac.aux = {"hidden"};
  ExpectItsActions(run);
}

TEST(LearnedPolicies, OfTwoEncodersTheActorsOwnLeaves) {
  RunConfig run = policy::SmallRun("sac", /*pixels=*/true);
  run.config.network.encoders = "separate";
  run.config.network.target_encoder = true;
  ExpectItsActions(run);
}

}  // namespace
}  // namespace shoal::launch
