// SPDX-License-Identifier: Apache-2.0
// Properties of an algorithm that a run needs outside of learning: which keys fit, whether there is
// a replay, how actors explore. learner/agent/algorithms.cpp has the list that learning uses.
//
// A further algorithm is a line in both lists. The choices of learner.algorithm follow from the
// list here.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "common/config/config.h"

namespace shoal {

struct AlgorithmKind {
  std::string_view name;  // of learner.algorithm
  // From rollouts that go to the learner, by an unsquashed Gaussian; else from a replay.
  bool on_policy = false;
  // Its policy is a Gaussian squashed by tanh: takes network.log_std. Otherwise, off policy, the
  // policy is deterministic.
  bool squashed_gaussian = false;
  bool encoder_options = false;  // takes network.encoders, network.target_encoder
  // Section of keys that only algorithms with this section take: "ppo."; empty = none.
  std::string_view own_section = "";
};

std::span<const AlgorithmKind> AlgorithmKinds();
// The run's. CHECK: there is one, which the key's choices see to.
const AlgorithmKind& AlgorithmKindOf(const Config& config);

// Those of which `fits` is true, for messages: "sac | td3 | ddpg".
std::string AlgorithmsThat(bool (*fits)(const AlgorithmKind& kind));

}  // namespace shoal
