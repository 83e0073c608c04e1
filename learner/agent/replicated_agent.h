// SPDX-License-Identifier: Apache-2.0
// One agent that consists of N replicas (common/nn/replica.h), each with its own CPU engine. The
// agent's tensors are those of the first replica, and their names and shapes do not depend on N.
#pragma once

#include <functional>
#include <memory>

#include "common/config/config.h"
#include "common/nn/precision.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

// Makes the agent of one replica. This agent receives whole batches, and learns only from the rows
// of its engine. Borrows the engine.
using MakeReplica = std::function<std::unique_ptr<Agent>(Engine*)>;

// Makes an agent of `replicas` replicas for the batch size and the number of copies in `config`.
// All replicas must start with equal values, so the result of `make` may depend only on the engine.
// Each replica is made and run by its own thread, so that the replica's memory is on the NUMA node
// of this thread. Throws the errors of `make`.
std::unique_ptr<Agent> MakeReplicatedAgent(const Config& config, nn::Precision precision,
                                           int replicas, const MakeReplica& make);

// Whether the encoder has batch normalisation. Such networks cannot be replicated, because their
// statistics need the whole batch.
bool NormalisesOverBatch(const NetworkConfig& network, const ObservationSpec& spec);

}  // namespace shoal::learner
