// SPDX-License-Identifier: Apache-2.0
// A policy in the format of Stable-Baselines3: a zip archive whose policy.pth holds the state_dict
// of the algorithm's MlpPolicy or CnnPolicy, for MODEL.set_parameters(FILE, exact_match=False).
//
//                       squashed Gaussian        deterministic        unsquashed Gaussian
//   Shoal               (SAC)                    (TD3, DDPG, DrQ-v2)  (PPO)
//   encoder.conv{i}     X.cnn.{2i}               X.cnn.{2i}           X.cnn.{2i}
//   actor.trunk         X.linear.0               X.linear.0           X.linear.0
//   actor.mlp.layer{i}  actor.latent_pi.{2i}     actor.mu.{2i}        mlp_extractor.policy_net.{2i}
//   actor.mlp.output    actor.mu, actor.log_std  actor.mu.{2 layers}  action_net
//   actor.log_std                                                     log_std
//
// X: actor.features_extractor; for PPO features_extractor and pi_features_extractor, which are the
// same module. Critics of the model are not changed. If the policy normalises observations, the
// archive's pytorch_variables.pth contains mean and variance of the observations, for a
// VecNormalize around the environment; set_parameters ignores this file.
//
// Source: Stable-Baselines3 2.9, common/policies.py, common/torch_layers.py (NatureCNN),
// common/save_util.py, sac/policies.py, td3/policies.py.
#pragma once

#include <string>
#include <vector>

#include "common/policy/checkpoint_policy.h"

namespace shoal::launch {

struct Sb3File {
  std::string bytes;
  // Python expression for a model that the file fits: "SAC("MlpPolicy", env, policy_kwargs=...)".
  std::string model;
  // Properties that the model does not take from the file, one sentence each.
  std::vector<std::string> notes;
};

// If a part of the algorithm or network has no counterpart in Stable-Baselines3, throws Error
// (usage) naming the part. If a tensor does not match, throws Error naming the tensor.
Sb3File WriteSb3(const policy::CheckpointPolicy& policy);

}  // namespace shoal::launch
