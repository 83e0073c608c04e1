// SPDX-License-Identifier: Apache-2.0
// The moving average of a policy's parameters (Eq. 12 of docs/algorithm.md). No network in the
// learner computes with this average.
//
// Replicas share the values of the average, and each replica updates a part of the values. The
// values are read only after the update has ended for all replicas.
#pragma once

#include <deque>
#include <vector>

#include "common/nn/parameter_set.h"
#include "common/nn/safetensors.h"
#include "learner/agent/agent_state.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

// Not movable. Only the thread of the replica may use an object.
class PolicyAverage {
 public:
  // Borrows sets and engine.
  PolicyAverage(const std::vector<nn::ParameterSet*>& policy, Engine* engine);
  PolicyAverage(const PolicyAverage&) = delete;
  PolicyAverage& operator=(const PolicyAverage&) = delete;

  // Sets the average to the policy.
  void Copy();
  // average += rate * (policy - average) if the update's flag is set (Engine::MoveAverage). Running
  // statistics are copied without averaging.
  void Move(float rate);

  // Returns the average under the policy's own names.
  nn::TensorMap Tensors() const;
  // Adds the average's tensors under the names "average.NAME".
  void AddTo(AgentState* state);

 private:
  const std::vector<nn::ParameterSet*> policy_;
  Engine* const engine_;
  std::deque<nn::ParameterSet> averages_;  // one for each set
};

}  // namespace shoal::learner
