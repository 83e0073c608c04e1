// SPDX-License-Identifier: Apache-2.0
// The algorithms that learner.algorithm selects, as used by the learner.
// common/config/algorithm_kind.h lists them in the same order, with the properties that keys,
// actors and launch use.
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
  std::string_view name;  // value of learner.algorithm
  // Figures that its updates report, in this order. An update reports every figure that it
  // computes.
  std::span<const Figure* const> figures;
  int critics = 0;  // trained Q functions, each with a target; 0 on policy
  // Class of Stable-Baselines3 with the same policy network; empty if there is none.
  std::string_view sb3 = "";
  // Makes an agent that computes with `engine`, which it borrows. Initialises the networks from
  // config.seed. Throws Error if the configuration does not fit.
  std::unique_ptr<Agent> (*make)(const Config& config, const ObservationSpec& spec,
                                 Engine* engine) = nullptr;
  // Whether the algorithm can run as replicas, each with its own engine and a share of the rows of
  // each batch (replicated_agent.h). If not, threads share each pass of the networks.
  bool divides_rows = true;
};

std::span<const Algorithm> Algorithms();
// Throws Error (kUsage) that lists the existing algorithms if there is none of this name.
const Algorithm& FindAlgorithm(std::string_view name);

// Returns the number of replicas (common/nn/replica.h) for `threads` threads. This is one per
// thread, or a single replica with several threads per pass if the algorithm does not divide rows,
// or if the encoder has batch normalisation, whose statistics need the whole batch. Throws Error
// (kUsage) if the replicas cannot share the batch (CheckReplicas), and the errors of MakeAgent.
int ReplicasOf(const Config& config, const ObservationSpec& spec, int threads);

// Text about the learner's threads: "2 threads, a replica each".
std::string DescribeThreads(const Config& config, const ObservationSpec& spec, int threads,
                            int cores);

// Makes the agent of config.learner.algorithm, for nn::Threads() threads. Throws the errors of
// FindAlgorithm.
std::unique_ptr<Agent> MakeAgent(const Config& config, const ObservationSpec& spec,
                                 nn::Precision precision);

// Makes a run's agent.
using AgentFactory = std::function<std::unique_ptr<Agent>(
    const Config& config, const ObservationSpec& spec, nn::Precision precision)>;

// Every figure that the updates of a run may have, in the order of algorithms, each name once.
std::span<const Figure* const> AllFigures();
// Returns the figure of this name; nullptr if no update reports one.
const Figure* FindFigure(std::string_view name);

}  // namespace shoal::learner
