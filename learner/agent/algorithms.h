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
#include "common/spec/observation_spec.h"
#include "learner/agent/agent.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

struct Algorithm {
  std::string_view name;  // of learner.algorithm
  // Figures that its updates report, in this order; each at least in every update that computes it.
  std::span<const Figure* const> figures;
  int critics = 0;  // Q functions that an update moves, each with a target; on policy none
  // Class of Stable-Baselines3 with the same policy network; empty: none.
  std::string_view sb3 = "";
  // Computes with the engine, which it borrows. Initialises the networks from config.seed. Throws
  // Error where the configuration does not fit.
  std::unique_ptr<Agent> (*make)(const Config& config, const ObservationSpec& spec,
                                 Engine* engine) = nullptr;
  // Whether several agents, each with an engine and a share of the rows of each batch, are one
  // agent (replicated_agent.h). Otherwise threads share each pass of its networks.
  bool divides_rows = true;
};

std::span<const Algorithm> Algorithms();
// Throws Error (kUsage) naming those there are when there is none of that name.
const Algorithm& FindAlgorithm(std::string_view name);

// In how many replicas (common/nn/replica.h) `threads` threads learn: one a thread; a single one,
// whose passes they share, where the algorithm does not divide rows or the encoder has batch
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
