// SPDX-License-Identifier: Apache-2.0
// Properties of an algorithm that a run needs outside learning: the keys that fit, whether the run
// has a replay, and how actors explore. learner/agent/algorithms.cpp has the list that learning
// uses.
//
// A new algorithm needs a line in both lists. This list defines the choices of learner.algorithm.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "common/config/config.h"

namespace shoal {

struct AlgorithmKind {
  std::string_view name;  // of learner.algorithm
  // True: the algorithm learns from rollouts that actors send to the learner, and its policy is an
  // unsquashed Gaussian. False: the algorithm learns from a replay.
  bool on_policy = false;
  // True: the policy is a Gaussian squashed by tanh and uses network.log_std. False for an
  // off-policy algorithm: the policy is deterministic.
  bool squashed_gaussian = false;
  bool encoder_options = false;  // takes network.encoders, network.target_encoder
  // Section of keys that only algorithms with this section take: "ppo."; empty = none.
  std::string_view own_section = "";
};

std::span<const AlgorithmKind> AlgorithmKinds();
// The algorithm of the run. CHECKs that the algorithm exists; the choices of the key ensure it.
const AlgorithmKind& AlgorithmKindOf(const Config& config);

// Names of the algorithms for which `fits` is true, for messages: "sac | td3 | ddpg".
std::string AlgorithmsThat(bool (*fits)(const AlgorithmKind& kind));

}  // namespace shoal
