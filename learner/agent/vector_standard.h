// Vectors as an algorithm's networks see them with learner.normalise_vectors: at about mean 0 and
// deviation 1, by the moments of all vectors of earlier updates. The moments belong to the policy:
// actors and evaluations scale by those that came with their weights (common/nn/vector_scale.h).
//
// Dimensions: B batch, V vector size.
#pragma once

#include <span>
#include <vector>

#include "common/nn/safetensors.h"
#include "common/wire/batch_schema.h"
#include "learner/agent/agent_state.h"
#include "learner/agent/running_moments.h"

namespace shoal::learner {

// One thread.
class VectorStandard {
 public:
  // Off, or without vectors: they stay as they are.
  VectorStandard(bool on, int vector_size) : on_(on && vector_size > 0), moments_(vector_size) {}

  // The batch with vectors as networks see them; valid until the next call.
  BatchView Seen(const BatchView& batch);
  // Takes the vectors (B, V) of a batch, as they came, into the moments.
  void Add(std::span<const float> vectors);

  // Into a policy's tensors.
  void ExportTo(nn::TensorMap* policy) const;
  // `state` borrows the moments, where there are any.
  void AddTo(AgentState* state);

 private:
  const bool on_;
  RunningMoments moments_;
  std::vector<float> obs_, next_obs_;  // (B, V), scaled
};

}  // namespace shoal::learner
