// SPDX-License-Identifier: Apache-2.0
// Operands of an engine's operations (engine.h): handles of arrays that belong together.
// Dimensions: b rows of this replica, A actions.
#pragma once

#include <span>
#include <vector>

#include "common/base/random.h"
#include "common/nn/array.h"
#include "learner/engine/losses.h"

namespace shoal::learner {

using nn::Array;
using nn::Frames;
using nn::Number;
using Moments = nn::ArrayOf<double>;  // moments.h

// The rows of this replica in a batch, valid as long as the batch. Arrays that the batch lacks are
// empty.
struct Transitions {
  Frames obs_frames, next_obs_frames;
  Array obs_vector, next_obs_vector, obs_privileged, next_obs_privileged;
  Array action, reward, bootstrap;
  Array drawn_action, log_prob;  // rollouts only
  // The steps of the rows' sequences (BatchOptions::horizon), with the arrays of batch_schema.h.
  struct Step {
    Frames next_frames;
    Array next_vector, action, reward, terminated, present;
  };
  std::vector<Step> steps{};
};

// Actions of a Gaussian squashed by tanh, and the values that their gradients need.
struct SquashedSample {
  Array scaled_noise, action;  // (b, A): sigma eps, a
  Array log_prob;              // (b): log pi(a | o)
};

// Inputs of the targets of a batch: (b) each.
struct TargetTerms {
  Array reward, bootstrap;        // bootstrap: discount^(n-1) (1 - terminated)
  std::span<const Array> next_q;  // one or more target critics at (o', a')
  int drawn = 0;                  // critics of next_q that count, drawn from `random`; 0 = all
  Random* random = nullptr;       // read if critics are drawn
  Array next_log_prob;            // log pi(a' | o'); empty: no entropy term
  Number temperature;             // weight of the entropy term
  float reward_scale = 1, discount = 1;
  ValueBounds bounds;
};

// How a critic's loss counts the rows of a batch (Eq. 34).
struct CriticRows {
  Array weights;                // (b) importance weights; empty: 1
  bool huber = false;           // errors beyond 1 count by their absolute values
  bool returns_errors = false;  // Engine::ReadErrors
};

// Figures of a critic's loss over the whole batch. q2 is empty if there is one Q function.
struct CriticNumbers {
  Number loss, q_mean, target_mean;
  Number q1_mean, q1_std, q2_mean, q2_std;
  Number q_min_mean, q_min_std, q_min_min, q_min_max;
};

// Inputs of the clipped loss of a policy whose log deviation is a parameter, and of its values.
// Arrays are (b); arrays of actions are (b, A).
struct ClippedPolicyTerms {
  Array mean, value;                   // outputs of the networks
  Array drawn_action, old_log_prob;    // from the policy that acted
  Array old_value, advantage, target;  // computed before the update
  Number clip;                         // bound of the ratio
  double value_clip = 0;               // 0: none
  double value_weight = 0.5, entropy_weight = 0;
  bool normalise_advantages = true;
};

// Figures of the clipped loss over the whole batch: the terms without their weights, and their
// weighted sum.
struct ClippedPolicyNumbers {
  Number policy, value, total;
  Number rounded_total;  // total in f32, the type of steps
  Number approx_kl, clip_fraction;
};

}  // namespace shoal::learner
