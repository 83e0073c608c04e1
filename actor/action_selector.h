// Chooses the actions of E environments at once: uniform random until the first weights, then the
// tanh-squashed Gaussian of the policy, or its mean.
//
//   a = tanh(mean + exp(log_std) * eps),  eps ~ N(0, I) from the episode's own stream
//
// One thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "actor/weights_inbox.h"
#include "common/base/random.h"
#include "common/config/config.h"
#include "common/nn/policy.h"
#include "common/spec/observation_spec.h"

namespace shoal::actor {

class ActionSelector {
 public:
  ActionSelector(const Config& config, const ObservationSpec& spec, int envs);

  // Throws Error when the weights do not fit the network; the former ones then stay.
  void Load(const ReceivedWeights& weights);
  WeightsVersion version() const { return version_; }

  // Starts the exploration stream of an episode of local environment `e`.
  void BeginEpisode(int e, uint64_t stream_key) { noise_[size_t(e)] = Random(stream_key); }

  // Where that stream is, to go on with it in another process.
  const Random::State& NoiseOf(int e) const { return noise_[size_t(e)].state(); }
  void SetNoise(int e, const Random::State& state) { noise_[size_t(e)].set_state(state); }

  // Where the loop writes the observations: (E, K*C, H, W) u8 and (E, V) f32.
  std::span<uint8_t> FrameStackOf(int e);
  std::span<float> VectorOf(int e);

  // actions (E, A) in [-1, 1], valid until the next call.
  void Select(bool deterministic);
  std::span<const float> ActionOf(int e) const;

 private:
  int envs_, action_size_, vector_size_, stack_bytes_;
  nn::Policy policy_;
  WeightsVersion version_;
  std::vector<Random> noise_;
  std::vector<uint8_t> frames_;
  std::vector<float> vectors_, mean_, log_std_, actions_;
};

}  // namespace shoal::actor
