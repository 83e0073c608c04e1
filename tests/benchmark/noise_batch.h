// SPDX-License-Identifier: Apache-2.0
// A batch of noise for agents of the default task, or a rollout of one environment.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "common/base/aligned_bytes.h"
#include "common/base/random.h"
#include "common/config/config.h"
#include "common/config/sequences.h"
#include "common/spec/observation_spec.h"
#include "common/wire/batch_schema.h"

namespace shoal::bench {

// Spec with the 84x84 frames of two cameras, which together have `channels` channels.
inline ObservationSpec PixelSpec(int channels = 6) {
  ObservationSpec spec;
  spec.task = "bench";
  spec.cameras = {"front", "side"};
  spec.channels = channels;
  spec.height = spec.width = 84;
  spec.action_size = 4;
  return spec;
}

// Spec with 13 numbers and no pixels.
inline ObservationSpec VectorSpec() {
  ObservationSpec spec = PixelSpec();
  spec.cameras.clear();
  spec.channels = spec.height = spec.width = 0;
  spec.blocks = {{"observation", 13}};
  return spec;
}

// The networks of the preset state-mrq.
inline Config LatentModel(int batch) {
  Config config;
  config.observation.pixels = false;
  config.learner.algorithm = "mrq";
  config.learner.batch = batch;
  config.network.state_hidden = {128, 128, 128};
  config.network.hidden = {128, 128};
  return config;
}

// Not movable, because `batch` borrows the schema.
struct NoiseBatch {
  NoiseBatch(const Config& config, const ObservationSpec& spec)
      : NoiseBatch(spec, {.batch = config.learner.batch, .horizon = HorizonOf(config)}) {}
  NoiseBatch(const ObservationSpec& spec, const BatchOptions& options, uint64_t seed = 1)
      : schema(spec, options) {
    Random random(seed);
    const auto fill = [&](auto& array, double low, double high) {
      for (auto& x : array) {
        x = static_cast<std::remove_reference_t<decltype(x)>>(random.Uniform(low, high));
      }
    };
    fill(batch.obs_frames, 0, 256);
    fill(batch.next_obs_frames, 0, 256);
    fill(batch.obs_vector, -1, 1);
    fill(batch.next_obs_vector, -1, 1);
    fill(batch.action, -1, 1);
    fill(batch.reward, -0.3, 0);
    fill(batch.bootstrap, 1, 1);
    fill(batch.weights_update, 0, 1);
    fill(batch.drawn_action, -1, 1);
    fill(batch.ends, 0, 0);
    fill(batch.continues, 1, 1);
    for (StepView& step : batch.steps) {
      fill(step.next_frames, 0, 256);
      fill(step.next_vector, -1, 1);
      fill(step.action, -1, 1);
      fill(step.reward, -0.3, 0);
      fill(step.terminated, 0, 0);
      fill(step.present, 1, 1);
    }
    if (!batch.continues.empty()) batch.continues.back() = 0;
    SetLogProbs();
  }
  NoiseBatch(const NoiseBatch&) = delete;
  NoiseBatch& operator=(const NoiseBatch&) = delete;

  // Log-probabilities of an untrained policy, whose means are about 0 and deviations 1.
  void SetLogProbs() const {
    for (size_t b = 0; b < batch.log_prob.size(); ++b) {
      const size_t actions = batch.drawn_action.size() / batch.log_prob.size();
      batch.log_prob[b] = 0;
      for (const float u : batch.drawn_action.subspan(b * actions, actions)) {
        batch.log_prob[b] -= u * u / 2 + 0.9189385f;
      }
    }
  }

  BatchSchema schema;
  AlignedBytes memory{schema.total_bytes()};
  BatchView batch = schema.View(memory.data());
};

}  // namespace shoal::bench
