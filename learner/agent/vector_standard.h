// SPDX-License-Identifier: Apache-2.0
// If learner.normalise_vectors is set, scales the input vectors of an algorithm's networks to about
// mean 0 and deviation 1, by the moments of all vectors of earlier updates. The moments of
// observations belong to the policy: actors and evaluations use the moments that were sent with
// their weights (common/nn/vector_scale.h). The moments of privileged blocks stay in the learner. A
// variance below learner.variance_floor is replaced by the floor, also in the policy's tensors.
//
// Dimensions: b rows of this replica, V vector size, P privileged size.
#pragma once

#include <optional>
#include <string>

#include "common/config/config.h"
#include "common/nn/pending_tensors.h"
#include "common/nn/safetensors.h"
#include "common/wire/batch_schema.h"
#include "learner/agent/agent_state.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

// Only one thread may use an object.
class VectorStandard {
 public:
  // Borrows the engine. Without learner.normalise_vectors, or without vectors, this object changes
  // nothing.
  VectorStandard(const LearnerConfig& learner, Engine* engine, int vector_size,
                 int privileged_size = 0);

  // Returns the batch with normalised vectors; valid until the next call.
  Transitions Seen(const Transitions& batch);
  // Adds the unscaled vectors of a whole batch to the moments.
  void Add(const BatchView& batch);

  // Adds mean and variance to a policy's tensors. The second function does not wait for updates in
  // flight.
  void ExportTo(nn::TensorMap* policy) const;
  void ExportTo(nn::PendingTensors* policy) const;
  // Adds the moments, if there are any, to `state`, which borrows them.
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
  // Empty if these vectors are not normalised.
  std::optional<Part> observed_, privileged_;
};

}  // namespace shoal::learner
