// SPDX-License-Identifier: Apache-2.0
// Chooses the actions of E environments together. The actions are uniform random until the first
// weights arrive. After that they are the policy's actions, with or without exploration.
//
// One thread.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "actor/acting/exploration.h"
#include "actor/acting/weights_inbox.h"
#include "common/base/random.h"
#include "common/config/config.h"
#include "common/nn/policy.h"
#include "common/spec/observation_spec.h"

namespace shoal::actor {

// Mode in which actions are chosen. Before the first weights, all modes give uniform random
// actions.
enum class Acting {
  kUniform,  // each component ~ U(-1, 1)
  kExplore,  // actor/acting/exploration.h
  kMean,     // for evaluation: tanh(mean), or clip(mean, -1, 1) if the policy is unsquashed
};

class ActionSelector {
 public:
  // `actor`: number of the actor within the run; selects the actor's noise factor.
  ActionSelector(const Config& config, const ObservationSpec& spec, int envs, uint32_t actor = 0);

  // Loads weights. If the weights do not fit the network, throws Error and keeps the old weights.
  void Load(const ReceivedWeights& weights);
  WeightsVersion version() const { return version_; }
  // Env steps of the whole run when the loaded weights were made; 0 before the first weights.
  uint64_t run_env_steps() const { return run_env_steps_; }

  // Starts the exploration stream of an episode of local environment `e`.
  void BeginEpisode(int e, uint64_t stream_key);

  // State of an environment's exploration: the position of its random stream, and the numbers that
  // the noise carries from step to step. With this state another process can continue the
  // exploration.
  struct Noise {
    Random::State stream{};
    std::vector<double> carried{};
    bool operator==(const Noise&) const = default;
  };
  Noise NoiseOf(int e) const;
  // Throws Error if the state belongs to another kind of exploration.
  void SetNoise(int e, const Noise& noise);

  // Memory into which the loop writes the observation of environment `e`: its stack (I, H, W) u8
  // and its vector (V) f32. I, V: sizes of the policy's input (actor/acting/episode_runner.h); A:
  // components of an action.
  std::span<uint8_t> FrameStackOf(int e);
  std::span<float> VectorOf(int e);

  // Chooses an action (A) in [-1, 1] for each environment; the actions are valid until the next
  // call. `asked` (E) selects environments; empty = all. The actions and the noise of the other
  // environments do not change.
  void Select(Acting acting, const std::vector<bool>& asked = {});
  std::span<const float> ActionOf(int e) const;
  // After kExplore, if the spec has drawn actions: the drawn action (A), before it was clipped, and
  // its log-probability. Otherwise empty and 0.
  std::span<const float> DrawnOf(int e) const;
  float LogProbOf(int e) const { return log_probs_[size_t(e)]; }

 private:
  int envs_, action_size_, vector_size_, stack_bytes_;
  nn::Policy policy_;
  std::unique_ptr<Exploration> exploration_;
  WeightsVersion version_;
  uint64_t run_env_steps_ = 0;
  std::vector<Random> streams_;
  std::vector<uint8_t> frames_;
  std::vector<float> vectors_, actions_;
  std::vector<float> drawn_;      // (E, A); empty unless the spec has drawn actions
  std::vector<float> log_probs_;  // (E)
};

}  // namespace shoal::actor
