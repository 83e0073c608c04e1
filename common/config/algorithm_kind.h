// SPDX-License-Identifier: Apache-2.0
// Properties of algorithms that code outside of the learner needs: the keys that an algorithm
// accepts, whether the run has a replay, and how actors explore. A second list, in
// learner/agent/algorithms.cpp, is for the learner.
//
// A new algorithm needs a line in each of the two lists. The list here defines the choices of the
// key learner.algorithm.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "common/config/config.h"

namespace shoal {

struct AlgorithmKind {
  std::string_view name;  // value of learner.algorithm
  // True: the algorithm learns from rollouts that actors send to the learner, and its policy is an
  // unsquashed Gaussian. False: the algorithm learns from a replay.
  bool on_policy = false;
  // True: the policy is a Gaussian squashed by tanh and uses network.log_std. If this is false and
  // the algorithm is off policy, the policy is deterministic.
  bool squashed_gaussian = false;
  bool encoder_options = false;  // accepts network.encoders and network.target_encoder
  // Accepts replay.priorities: its critics' loss has weights and returns errors.
  bool priorities = false;
  // Section of keys that only algorithms with this section accept: "ppo."; empty = no section.
  std::string_view own_section = "";
  // Steps that follow each other in one sample of a batch (BatchOptions::horizon), its key
  // "horizon"; null = samples without such steps.
  int (*horizon)(const Config& config) = nullptr;
  // The algorithm's own deviation of the actors' noise, its key "noise"; null = exploration.sigma.
  const Schedule& (*own_noise)(const Config& config) = nullptr;
};

std::span<const AlgorithmKind> AlgorithmKinds();
// The algorithm of the run. CHECKs that the algorithm exists, which the choices of the key ensure.
const AlgorithmKind& AlgorithmKindOf(const Config& config);

// Names of the algorithms for which `fits` is true, for messages: "sac | td3 | ddpg".
std::string AlgorithmsThat(bool (*fits)(const AlgorithmKind& kind));

}  // namespace shoal
