// SPDX-License-Identifier: Apache-2.0
// Vectors as an algorithm's networks see them with learner.normalise_vectors: at about mean 0 and
// deviation 1, by the moments of all vectors of earlier updates. Those of the observation belong to
// the policy: actors and evaluations scale by those that came with their weights
// (common/nn/vector_scale.h). Those of privileged blocks stay with the learner. A variance below
// learner.variance_floor counts as the floor, also in the policy's tensors.
//
// Dimensions: b rows of this replica, V vector size, P privileged size.
#pragma once

#include <optional>
#include <string>

#include "common/config/config.h"
#include "common/nn/safetensors.h"
#include "common/wire/batch_schema.h"
#include "learner/agent/agent_state.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

// One thread.
class VectorStandard {
 public:
  // Borrows the engine. Without learner.normalise_vectors, or without vectors, they stay as they
  // are.
  VectorStandard(const LearnerConfig& learner, Engine* engine, int vector_size,
                 int privileged_size = 0);

  // The batch with vectors as networks see them; valid until the next call.
  Transitions Seen(const Transitions& batch);
  // Takes the vectors of a whole batch, as they came, into the moments.
  void Add(const BatchView& batch);

  // Into a policy's tensors.
  void ExportTo(nn::TensorMap* policy) const;
  // `state` borrows the moments, where there are any.
  void AddTo(AgentState* state);

 private:
  struct Part {
    Moments moments;
    Array obs, next_obs;  // (b, V) or (b, P), scaled
  };

  Part MakePart(int size) const;
  void AddTo(AgentState* state, const Part& part, const std::string& name) const;

  Engine* const engine_;
  const float variance_floor_;
  // Nothing: they stay as they are.
  std::optional<Part> observed_, privileged_;
};

}  // namespace shoal::learner
