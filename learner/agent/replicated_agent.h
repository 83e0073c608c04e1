// SPDX-License-Identifier: Apache-2.0
// An agent of N replicas (common/nn/replica.h), each with an engine of the CPU, that looks like one
// agent from outside: its tensors are those of the first replica and do not depend on N.
#pragma once

#include <functional>
#include <memory>

#include "common/config/config.h"
#include "common/nn/precision.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

// Makes the agent of one replica, which is given whole batches and learns from its engine's rows of
// them. Borrows the engine.
using MakeReplica = std::function<std::unique_ptr<Agent>(Engine*)>;

// Replicas for the batch and the copies of `config`. All start alike: `make` may depend on nothing
// but its engine. Each is made and run by a thread of its own, so that its memory is on that
// thread's node. Throws what `make` throws.
std::unique_ptr<Agent> MakeReplicatedAgent(const Config& config, nn::Precision precision,
                                           int replicas, const MakeReplica& make);

// Whether the encoder has batch normalisation. Its statistics are of the whole batch, so such
// networks cannot be replicas.
bool NormalisesOverBatch(const NetworkConfig& network, const ObservationSpec& spec);

}  // namespace shoal::learner
