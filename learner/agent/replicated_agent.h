// SPDX-License-Identifier: Apache-2.0
// An agent of N replicas (common/nn/replica.h) that looks like one agent from outside: its tensors
// are those of the first replica and do not depend on N.
#pragma once

#include <functional>
#include <memory>

#include "common/config/config.h"
#include "common/nn/replica.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent.h"

namespace shoal::learner {

// Makes the agent of one replica, which is given whole batches and learns from its rows of them.
// Borrows the replica.
using MakeReplica = std::function<std::unique_ptr<Agent>(nn::Replica*)>;

// Replicas for the batch and the copies of `config`. All start alike: `make` may depend on nothing
// but its replica's rank and number. Each is made and run by a thread of its own, so that its
// memory lies on the node of that thread. Throws what `make` throws.
std::unique_ptr<Agent> MakeReplicatedAgent(const Config& config, int replicas,
                                           const MakeReplica& make);

// Whether a run's networks can be replicas: not those with batch normalisation, whose statistics
// are of the whole batch.
bool NormalisesOverBatch(const NetworkConfig& network, const ObservationSpec& spec);

}  // namespace shoal::learner
