// SPDX-License-Identifier: Apache-2.0
// An agent of N replicas (common/nn/replica.h), which is one agent to everybody else: its tensors
// are those of the first, which alone has moments and the policy's average, and of no number of
// replicas.
#pragma once

#include <functional>
#include <memory>

#include "common/config/config.h"
#include "common/nn/replica.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent.h"

namespace shoal::learner {

// Makes the agent of one replica, which gets whole batches and learns from its part of them.
// Borrows the replica.
using MakeReplica = std::function<std::unique_ptr<Agent>(nn::Replica*)>;

// The same start for all: `make` may depend on nothing but its replica's rank and number.
std::unique_ptr<Agent> MakeReplicatedAgent(int replicas, const MakeReplica& make);

// Whether a run's networks can be replicas: not those with batch normalisation, whose statistics
// are of the whole batch.
bool NormalisesOverBatch(const NetworkConfig& network, const ObservationSpec& spec);

}  // namespace shoal::learner
