// SPDX-License-Identifier: Apache-2.0
// A batch of noise for agents of the default task.
#pragma once

#include <type_traits>

#include "common/base/aligned_bytes.h"
#include "common/base/random.h"
#include "common/config/config.h"
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

// Not movable, because `batch` borrows the schema.
struct NoiseBatch {
  NoiseBatch(const Config& config, const ObservationSpec& spec)
      : schema(spec, {.batch = config.learner.batch}) {
    Random random(1);
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
  }
  NoiseBatch(const NoiseBatch&) = delete;
  NoiseBatch& operator=(const NoiseBatch&) = delete;

  BatchSchema schema;
  AlignedBytes memory{schema.total_bytes()};
  BatchView batch = schema.View(memory.data());
};

}  // namespace shoal::bench
