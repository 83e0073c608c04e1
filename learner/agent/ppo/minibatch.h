// SPDX-License-Identifier: Apache-2.0
// Rows of a rollout, copied into a batch of the networks' batch size. The host copies the rows,
// because a minibatch is an input of the engine, like a batch of the replay server.
//
// Dimensions: N rows of the rollout, B rows of the minibatch, K frames of a stack, (C, H, W) of a
// frame, V vector size, A actions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/spec/observation_spec.h"
#include "common/wire/batch_schema.h"

namespace shoal::learner {

class Minibatch {
 public:
  Minibatch(const ObservationSpec& spec, int batch);

  // Copies the observations of at most B rows to the first rows of the minibatch. The other rows of
  // the minibatch do not change. frames: (N, K*C, H, W); vectors: (N, V).
  void TakeObservations(std::span<const uint8_t> frames, std::span<const float> vectors,
                        std::span<const int> rows);
  // Copies B rows of the rollout: observations, rewards, drawn actions, log-probabilities.
  void Take(const BatchView& rollout, std::span<const int> rows);

  // View of the minibatch, valid until the next change. Arrays that Take does not copy are empty.
  BatchView View();

 private:
  const size_t batch_, frame_bytes_, vector_size_, action_size_;
  std::vector<uint8_t> frames_;           // (B, K*C, H, W)
  std::vector<float> vectors_, drawn_;    // (B, V), (B, A)
  std::vector<float> reward_, log_prob_;  // (B)
};

}  // namespace shoal::learner
