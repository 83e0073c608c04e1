// SPDX-License-Identifier: Apache-2.0
// The sections of the configuration that belong to one algorithm each (AlgorithmKind::own_section).
// An algorithm with keys of its own has a struct here and a member in Config (config.h).
#pragma once

#include <string>
#include <vector>

#include "common/config/schedule.h"
#include "common/config/state_blocks.h"

namespace shoal {

// Entropy temperature, and privileged inputs of learning (common/config/privileged_blocks.h).
struct SacConfig {
  std::string temperature = "auto";  // auto | fixed
  double initial_temperature = 0.1;
  double min_temperature = 0;            // lower bound of an automatic temperature
  double temperature_learning_rate = 0;  // 0 = learner.learning_rate
  double target_entropy = 0;             // 0 = target_entropy_per_action * (action size)
  double target_entropy_per_action = -1;
  int critics = 2;                  // Q functions, each with a target
  int target_critics = 0;           // targets drawn at random for each update; 0 = all
  std::string actor_value = "min";  // min | mean: value of the critics in the actor's loss
  int quantiles = 0;                // quantiles of the return that a critic computes; 0 = its mean
  int dropped_quantiles = 2;        // largest target quantiles left out, times `critics`
  StateBlocks critic_blocks = false;  // the critic's inputs in place of pixels; false = pixels
  std::vector<std::string> aux;       // auxiliary regression targets: BLOCK, or BLOCK-BLOCK
  double aux_weight = 1;              // weight of the auxiliary loss
};

// On-policy learning: each update uses one rollout of every environment and then discards it.
struct PpoConfig {
  int rollout_steps = 1024;                 // T steps of each environment in one rollout
  int epochs = 10;                          // passes over a rollout in one update
  Schedule clip = Schedule::Constant(0.2);  // ratios are clipped to [1 - clip, 1 + clip]
  double value_clip = 0;                    // limit for the change of a value; 0 = no limit
  double gae_lambda = 0.95;                 // weight of the advantages of later steps
  double entropy_weight = 0;                // weight of the policy's entropy in the loss
  double value_weight = 0.5;                // weight of the squared value error in the loss
  double target_kl = 0;              // an update ends early if the KL exceeds 1.5 * this; 0 = never
  bool normalise_advantages = true;  // normalise advantages in each minibatch
  bool normalise_rewards = false;    // scale rewards by the running deviation of returns
  std::string networks = "separate";  // separate | shared: networks of policy and value
  double initial_log_std = 0;         // log deviation of the policy before the first update
  int versions_ahead = 0;             // rollouts that begin before their weights arrive
  double rollout_deadline = 30;       // s; how long the learner waits for late rollouts
};

// Noise on a target's action. Actions are in [-1, 1]. The defaults are the values of Fujimoto et
// al. 2018, arXiv:1802.09477, table 3.
struct Td3Config {
  double target_noise = 0.2;       // standard deviation; 0 = no noise
  double target_noise_clip = 0.5;  // largest absolute value of the noise
};

// Noise on the actions of targets, of the actor's loss and of the training actors. The defaults are
// those of Yarats et al. 2021, arXiv:2107.09645, for easy tasks.
struct Drqv2Config {
  Schedule noise{.start = 1, .end = 0.1, .env_steps = 100'000};  // standard deviation
  // Largest absolute value of the noise in targets and in the actor's loss.
  double noise_clip = 0.3;
};

// A latent model that predicts `horizon` steps, and deterministic control in its latent state. The
// defaults are the values of Fujimoto et al. 2025, arXiv:2501.16142.
struct MrqConfig {
  int horizon = 5;                      // steps that the model predicts in an update
  int period = 250;                     // updates between copies of the trained networks
  double encoder_learning_rate = 1e-4;  // of encoder and model
  double reward_weight = 0.1;           // weight of the predicted rewards in the model's loss
  double end_weight = 0.1;              // weight of the predicted ends of episodes
  double target_noise = 0.2;            // standard deviation of the noise on a target's action
  double target_noise_clip = 0.3;       // largest absolute value of this noise
};

}  // namespace shoal
