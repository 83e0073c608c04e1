// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/samples.h"

#include <gtest/gtest.h>

#include <cstring>

#include "common/nn/safetensors.h"
#include "launch/tools/export/policy_actions.h"
#include "tests/launch/tools/export/random_policy.h"

namespace shoal::launch {
namespace {

TEST(Samples, HoldEverySetsObservationsAndActions) {
  const policy::CheckpointPolicy policy = RandomPolicy({"compact"});
  const ObservationSpec& spec = policy.description.spec;
  const ObservationSet one = RandomObservations(spec, {}, 1, 1);
  const ObservationSet two = RandomObservations(spec, {}, 2, 2);
  const nn::TensorMap tensors = nn::ReadSafetensors(WriteSamples(policy, {one, two}), "samples");
  ASSERT_EQ(tensors.size(), 4u);
  const nn::NamedTensor& pixels = tensors.at("pixels");
  EXPECT_EQ(pixels.dtype, "U8");
  EXPECT_EQ(pixels.shape, (std::vector<int64_t>{3, 12, 48, 44}));
  EXPECT_EQ(pixels.data[one.frames.size()], two.frames[0]);
  EXPECT_EQ(tensors.at("grip").shape, (std::vector<int64_t>{3, 4}));
  const nn::NamedTensor& goal = tensors.at("goal");  // behind the grip in each vector
  float value;
  std::memcpy(&value, goal.data.data() + 3 * sizeof(float), sizeof(value));
  EXPECT_EQ(value, two.vectors[4]);
  const std::vector<float> actions = OwnActions(policy, two);
  std::memcpy(&value, tensors.at("action").data.data() + 3 * sizeof(float), sizeof(value));
  EXPECT_NEAR(value, actions[0], 1e-6);
}

}  // namespace
}  // namespace shoal::launch
