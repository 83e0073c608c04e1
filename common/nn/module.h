// SPDX-License-Identifier: Apache-2.0
// Modules: networks with parameters of their own, behind plain float arrays. The interface hides
// the library that computes the networks. Each algorithm (learner/agent) chooses its modules,
// targets and optimisers.
//
// Dimensions: B batch, A actions, V vector size. Arrays are row-major f32; a result is valid until
// the function that returned it is called again.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "common/nn/network_plan.h"
#include "common/nn/parameter_set.h"
#include "common/nn/precision.h"
#include "common/nn/replica.h"

namespace shoal::nn {

class NetworkMaker;  // networks.h
class Scratchpad;

// Statistics of batch normalisation. kBatch: statistics of the current batch, for a forward pass
// before a backward pass. kRunning: averages over earlier batches, for acting and for targets.
enum class Statistics { kBatch, kRunning };

// Context with which the modules of one computation are built. All copies of a context share one
// scratch memory. Modules that were built with these copies must therefore run one after another,
// on one thread at a time.
struct ModuleContext {
  ModuleContext(Precision precision, int batch, int threads);
  // Context of one replica, with its share of a batch of `batch` rows and its number of threads.
  // Borrows the replica.
  ModuleContext(Precision precision, int batch, Replica* replica);

  Precision precision;
  int batch;    // B, or the rows of the replica
  int threads;  // threads of each pass of a module
  Replica* replica = nullptr;
  NetworkMaker* maker = nullptr;  // null: networks of the CPU
  std::shared_ptr<Scratchpad> scratchpad;
};

// Base class of modules. Use::kTraining: the module has gradients, and an optimiser can train it.
// Use::kInference: the module is a target or a policy.
class Module {
 public:
  using Use = ParameterSet::Use;

  Module(const std::vector<ParameterSpec>& parameters, Use use, const ModuleContext& context);
  virtual ~Module() = default;

  // Owned by the module. Call Refresh() after every change of their values.
  ParameterSet& parameters() { return parameters_; }
  const ParameterSet& parameters() const { return parameters_; }
  // Copies the parameters' current values into the layers. With replicas, all replicas must call
  // Refresh and then pass a barrier (LaidOutWeight::Refresh).
  virtual void Refresh() = 0;

 protected:
  ParameterSet parameters_;
  const ModuleContext context_;
};

// Copies the parameters and statistics of `online` to `target`, a network of the same plan under
// another name, and refreshes the target.
void CopyParameters(const Module& online, Module* target);

// A target network and the online module that it follows.
struct Following {
  const Module* online;
  Module* target;
};
// Computes target += tau * (online - target) for the parameters of each target (Eq. 9 of
// docs/algorithm.md), copies running statistics without averaging, and refreshes the targets.
// Replicas divide the work. They pass a barrier inside this function, and must pass another barrier
// (Replica::Meet) before any of them uses the targets.
void MoveTowards(float tau, std::span<const Following> targets, Replica* replica);

// Does the same for one target without replicas.
void MoveTowards(float tau, const Module& online, Module* target);

// The next two functions are for a moving average that belongs to no module.
//
// Copies the parameters and statistics of `online` to `average`.
void CopyParameters(const ParameterSet& online, ParameterSet* average);
// Moves only this replica's share of the average. Other replicas may move their shares at the same
// time.
void MoveTowards(float tau, const ParameterSet& online, ParameterSet* average,
                 const Replica& replica);

}  // namespace shoal::nn
