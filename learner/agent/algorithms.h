// SPDX-License-Identifier: Apache-2.0
// The algorithms, as the learner knows them: what learner.algorithm chooses from. What keys, actors
// and launch know of each is in common/config/algorithm_kind.h, in the same order.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "common/config/config.h"
#include "common/nn/precision.h"
#include "common/nn/replica.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent.h"

namespace shoal::learner {

struct Algorithm {
  std::string_view name;  // of learner.algorithm
  // Figures that its updates report, in this order; each at least in every update that computes it.
  std::span<const Figure* const> figures;
  int critics = 0;  // Q functions that an update moves, each with a target; on policy none
  // Class of Stable-Baselines3 with the same policy network; empty: none.
  std::string_view sb3 = "";
  // Either of the two. Initialises the networks from config.seed. Throws Error where the
  // configuration does not fit.
  //
  // An agent that knows no replicas: nn::Threads share each pass of its networks.
  std::unique_ptr<Agent> (*make)(const Config& config, const ObservationSpec& spec,
                                 nn::Precision precision) = nullptr;
  // One of replicas, or the only one: replicated_agent.h. Borrows the replica. Only the first one's
  // AllTensors and AveragedPolicyTensors are asked for.
  std::unique_ptr<Agent> (*make_replica)(const Config& config, const ObservationSpec& spec,
                                         nn::Precision precision, nn::Replica* replica) = nullptr;
};

std::span<const Algorithm> Algorithms();
// Throws Error (kUsage) naming those there are when there is none of that name.
const Algorithm& FindAlgorithm(std::string_view name);

// In how many replicas (common/nn/replica.h) `threads` threads learn: one a thread; a single one,
// whose passes they share, where the algorithm knows no replicas or the encoder has batch
// normalisation, whose statistics are of the whole batch. Throws Error (kUsage) where they cannot
// share the batch (CheckReplicas), and as MakeAgent.
int ReplicasOf(const Config& config, const ObservationSpec& spec, int threads);

// Text about the learner's threads: "2 threads, a replica each".
std::string DescribeThreads(const Config& config, const ObservationSpec& spec, int threads,
                            int cores);

// The agent of config.learner.algorithm, for nn::Threads. Throws as FindAlgorithm.
std::unique_ptr<Agent> MakeAgent(const Config& config, const ObservationSpec& spec,
                                 nn::Precision precision);

// Makes a run's agent.
using AgentFactory = std::function<std::unique_ptr<Agent>(
    const Config& config, const ObservationSpec& spec, nn::Precision precision)>;

// Every figure that the updates of a run may have, by algorithm, each name once.
std::span<const Figure* const> AllFigures();
// The figure of that name; nullptr: no update reports one.
const Figure* FindFigure(std::string_view name);

}  // namespace shoal::learner
