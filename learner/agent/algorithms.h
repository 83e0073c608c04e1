// SPDX-License-Identifier: Apache-2.0
// The algorithms that learner.algorithm selects, with the properties that the learner uses.
// common/config/algorithm_kind.h lists the algorithms in the same order, with the properties that
// keys, actors and launch use.
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
  // Metrics that the algorithm's updates may report, in this order.
  std::span<const Figure* const> figures;
  int critics = 0;  // trained Q functions, each with a target; 0 on policy
  // Returns the number of trained Q functions if keys set this number; null: `critics`.
  int (*critics_of)(const Config& config) = nullptr;
  // Class of Stable-Baselines3 with the same policy network; empty if there is no such class.
  std::string_view sb3 = "";
  // Makes an agent that computes with `engine`, which it borrows. Initialises the networks from
  // config.seed. Throws Error if the configuration does not fit.
  std::unique_ptr<Agent> (*make)(const Config& config, const ObservationSpec& spec,
                                 Engine* engine) = nullptr;
  // Whether the algorithm can run as replicas, each with its own engine and a share of the rows of
  // each batch (replicated_agent.h). If not, threads share each pass of the networks.
  bool divides_rows = true;
  // Whether the engine of devices (learner/device) computes all operations of the algorithm.
  bool on_devices = true;
};

std::span<const Algorithm> Algorithms();
// If there is no algorithm of this name, throws Error (kUsage) that lists the existing algorithms.
const Algorithm& FindAlgorithm(std::string_view name);

// Number of the trained Q functions of config.learner.algorithm.
int CriticsOf(const Config& config);

// Returns the number of replicas (common/nn/replica.h) for `threads` threads. Usually there is one
// replica for each thread. There is a single replica, whose passes use all threads, if the
// algorithm does not divide rows, or if the encoder has batch normalisation, which needs statistics
// of the whole batch. Throws Error (kUsage) if the replicas cannot share the batch (CheckReplicas),
// and the errors of MakeAgent.
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

// All metrics that updates may have, in the order of algorithms, without duplicates.
std::span<const Figure* const> AllFigures();
// Returns the metric of this name; nullptr if no update reports such a metric.
const Figure* FindFigure(std::string_view name);

}  // namespace shoal::learner
